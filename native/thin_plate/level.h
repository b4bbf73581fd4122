// SPDX-License-Identifier: GPL-3.0-or-later
// The thin plate's operator on one level, for the solver.
#pragma once

#include <memory>

#include "multigrid/chebyshev.h"
#include "multigrid/level_operator.h"
#include "parallel/reductions.h"
#include "thin_plate/matrix.h"
#include "thin_plate/operator.h"

namespace fairing {

// Shared by all levels.
struct ThinPlateShared {
  const ControlMesh& mesh;
  const Stencils& stencils;
  ThinPlateRows<double> double_rows;
  ThinPlateRows<float> float_rows;
  Unknowns unknowns;
  Workers& workers;
  ElementSlots<double> double_slots;
  ElementSlots<float> float_slots;

  ThinPlateShared(const ControlMesh& control, const Stencils& s, Unknowns u, Workers& crew)
      : mesh(control),
        stencils(s),
        double_rows(control, s),
        float_rows(control, s),
        unknowns(std::move(u)),
        workers(crew) {}
};

// K plus the weights of control vertices, in the control metric or in that of a surface. In double
// always by passes; in single precision by a matrix if one suits the level.
class ThinPlateLevel final : public LevelOperator {
 public:
  ThinPlateLevel(ThinPlateShared& shared, const GridLevel& grid, const VertexWeights& weights)
      : shared_(shared),
        grid_(grid),
        matrix_(PlateMatrix::make(grid, shared.stencils, shared.unknowns, shared.workers)) {
    set_weights(weights);
  }

  // Switches to the metric of a surface of the level.
  void measure(const SurfaceMetric& metric) {
    matrix_.reset();
    surface_ = std::make_unique<SurfaceRows>(grid_, shared_.stencils, metric, shared_.unknowns,
                                             shared_.workers);
    matrix_ = PlateMatrix::make(grid_, shared_.stencils, shared_.unknowns, shared_.workers,
                                surface_.get());
    ++version_.spectrum;
    update();
  }
  bool is_measured() const { return surface_ != nullptr; }
  // r += P reference, in the metric of a surface.
  void add_penalty(const double* reference, double* r) const {
    for_each_index(shared_.workers, 3 * points(),
                   [&](std::size_t i) { r[i] += double(surface_->penalty[i / 3]) * reference[i]; });
  }

  void set_weights(VertexWeights weights) {
    weights_ = std::move(weights);
    update();
  }
  // Of all points. Smaller weights make the spectrum larger.
  void set_point_weights(VertexWeights weights) {
    ++version_.spectrum;
    set_weights(std::move(weights));
  }
  const VertexWeights& weights() const { return weights_; }

  // E(x), as thin_plate_energy().
  double bending(const double* x) {
    return thin_plate_energy(grid_, shared_.stencils, shared_.workers, x, surface_.get());
  }

  std::size_t points() const override { return grid_.size(); }
  std::size_t components() const override { return 3; }
  void apply(const double* x, double* y) override {
    apply_thin_plate(grid_, shared_.double_rows, shared_.unknowns, weights_, shared_.workers,
                     shared_.double_slots, x, y, surface_.get());
  }
  // (K + P) x without weights, with these control vertices among the unknowns.
  void apply_with(const Unknowns& unknowns, const double* x, double* y) {
    apply_thin_plate(grid_, shared_.double_rows, unknowns, {}, shared_.workers,
                     shared_.double_slots, x, y, surface_.get());
  }
  // Its diagonal.
  Array<float> diagonal_with(const Unknowns& unknowns) {
    return thin_plate_diagonal(grid_, shared_.stencils, unknowns, {}, shared_.workers,
                               shared_.double_slots, surface_.get());
  }
  void apply(const float* x, float* y) override {
    if (matrix_)
      return matrix_->visit_products(
          x, shared_.workers, [=](std::size_t first, std::size_t count, const float* product) {
            std::copy_n(product, 3 * count, y + 3 * first);
          });
    apply_thin_plate(grid_, shared_.float_rows, shared_.unknowns, weights_, shared_.workers,
                     shared_.float_slots, x, y, surface_.get());
  }
  void relax(const SmoothingStep& step, Workers& workers) override {
    if (!matrix_) return LevelOperator::relax(step, workers);
    matrix_->visit_products(step.d, workers,
                            [&](std::size_t first, std::size_t count, const float* product) {
                              finish_step(step, 3, inverse_diagonal_.data(), first, count, product);
                            });
  }
  void subtract_product(const float* x, float* room, float* y, Workers& workers) override {
    if (!matrix_) return LevelOperator::subtract_product(x, room, y, workers);
    matrix_->visit_products(x, workers,
                            [=](std::size_t first, std::size_t count, const float* product) {
                              for (std::size_t i = 0; i < 3 * count; ++i)
                                y[3 * first + i] -= product[i];
                            });
  }
  const Array<float>& inverse_diagonal() const override { return inverse_diagonal_; }
  AssembledSystem assemble() const override {
    return assemble_thin_plate(grid_, shared_.stencils, shared_.unknowns, weights_, shared_.workers,
                               surface_.get());
  }
  void write_lines(LineBand& band, Workers& workers) override {
    if (matrix_)
      matrix_->write_lines(inverse_diagonal_, band, workers);
    else
      write_plate_lines(grid_, shared_.stencils, shared_.unknowns, inverse_diagonal_, workers, band,
                        surface_.get());
  }

 private:
  // Updates the diagonal of K and the current weights.
  void update() {
    ++version_.numbers;
    if (matrix_) {
      matrix_->set_weights(weights_);
      inverse_diagonal_ = matrix_->inverse_diagonal(shared_.workers);
      return;
    }
    inverse_diagonal_ = thin_plate_diagonal(grid_, shared_.stencils, shared_.unknowns, weights_,
                                            shared_.workers, shared_.double_slots, surface_.get());
    for (float& d : inverse_diagonal_) d = 1 / d;
  }

  ThinPlateShared& shared_;
  const GridLevel& grid_;
  VertexWeights weights_;
  std::unique_ptr<SurfaceRows> surface_;  // null: the control metric
  std::unique_ptr<PlateMatrix> matrix_;   // null: passes are used
  Array<float> inverse_diagonal_;
};

}  // namespace fairing
