// SPDX-License-Identifier: GPL-3.0-or-later
// The thin plate's operator on one level, for the solver.
#pragma once

#include <memory>
#include <optional>

#include "parallel/reductions.h"
#include "thin_plate/differences.h"
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
  // Pieces of an edge up to which a matrix is faster. Passes `on_surface` read a row for each point
  // as well.
  static constexpr int most_pieces(bool on_surface) { return on_surface ? 32 : 8; }

  ThinPlateLevel(ThinPlateShared& shared, const GridLevel& grid, const VertexWeights& weights)
      : shared_(shared), grid_(grid) {
    measure_matrix();
    set_weights(weights);
  }

  // Switches to the metric of a surface of the level.
  void measure(const SurfaceMetric& metric) {
    matrix_.reset();
    surface_ = std::make_unique<SurfaceRows>(grid_, shared_.stencils, metric, shared_.unknowns,
                                             shared_.workers);
    ++version_.spectrum;
    measure_matrix();
    invert_diagonal();
  }
  bool is_measured() const { return surface_ != nullptr; }
  // Of the metric of a surface: one number a point.
  const Array<float>& penalty() const { return surface_->penalty; }
  // r += P reference, in the metric of a surface.
  void add_penalty(const double* reference, double* r) const {
    for_each_index(shared_.workers, 3 * points(),
                   [&](std::size_t i) { r[i] += double(surface_->penalty[i / 3]) * reference[i]; });
  }

  void set_weights(VertexWeights weights) {
    weights_ = std::move(weights);
    invert_diagonal();
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
    return thin_plate_diagonal(grid_, shared_.stencils, unknowns, shared_.workers,
                               shared_.double_slots, surface_.get());
  }
  void apply(const float* x, float* y) override {
    if (!matrix_)
      return apply_thin_plate(grid_, shared_.float_rows, shared_.unknowns, weights_,
                              shared_.workers, shared_.float_slots, x, y, surface_.get());
    matrix_->apply(x, shared_.workers, y);
    add_weighted(shared_.unknowns, weights_, shared_.workers, x, y);
  }
  const Array<float>& inverse_diagonal() const override { return inverse_diagonal_; }
  AssembledSystem assemble() const override {
    return assemble_thin_plate(grid_, shared_.stencils, shared_.unknowns, weights_, shared_.workers,
                               surface_.get());
  }
  void write_lines(LineBand& band, Workers& workers) override {
    if (matrix_)
      return band.write(inverse_diagonal_, [&](const auto& wants, const auto& visit) {
        matrix_->visit_numbers(workers, wants, visit);
      });
    const PlateDifferences rows = differences();
    band.write(inverse_diagonal_, [&](const auto& wants, const auto& visit) {
      visit_numbers(rows, workers, wants, visit);
    });
  }

 private:
  PlateDifferences differences() const {
    return {grid_, shared_.stencils, shared_.unknowns, shared_.workers, surface_.get()};
  }
  // Sets what belongs to the metric.
  void measure_matrix() {
    if (RingMatrix<3>::suits(grid_, most_pieces(surface_ != nullptr)))
      matrix_.emplace(differences(), shared_.workers);
    diagonal_ = diagonal_with(shared_.unknowns);
  }
  void invert_diagonal() {
    ++version_.numbers;
    inverse_diagonal_ = diagonal_;
    const std::vector<std::uint8_t>& moves = shared_.unknowns.vertex;
    for (std::size_t p = 0; p < weights_.size(); ++p)
      if (p >= moves.size() || moves[p]) inverse_diagonal_[p] += float(weights_[p]);
    for (float& d : inverse_diagonal_) d = d > 0 ? 1 / d : 1.0f;
  }

  ThinPlateShared& shared_;
  const GridLevel& grid_;
  VertexWeights weights_;
  std::unique_ptr<SurfaceRows> surface_;      // null: the control metric
  std::optional<RingMatrix<3>> matrix_;       // none: passes are used
  Array<float> diagonal_, inverse_diagonal_;  // without weights, and with them
};

}  // namespace fairing
