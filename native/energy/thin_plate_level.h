// SPDX-License-Identifier: GPL-3.0-or-later
// The thin plate as the solver sees it: its operator on one level, and the transfer to the next coarser one.
#pragma once

#include <memory>

#include "energy/assemble.h"
#include "energy/plate_matrix.h"
#include "energy/thin_plate.h"
#include "solver/chebyshev.h"
#include "solver/level_operator.h"
#include "transfer/transfer.h"
#include "transfer/written_transfer.h"

namespace fairing {

// What all levels share.
struct ThinPlateShared {
  const ControlMesh& mesh;
  const Stencils& stencils;
  ThinPlateRows<double> fine_rows;
  ThinPlateRows<float> fast_rows;
  Unknowns unknowns;
  VertexWeights weights;
  Workers& workers;
  Exchange<double> fine_exchange;
  Exchange<float> fast_exchange;

  ThinPlateShared(const ControlMesh& control, const Stencils& s, Unknowns u, VertexWeights w, Workers& crew)
      : mesh(control),
        stencils(s),
        fine_rows(control, s),
        fast_rows(control, s),
        unknowns(std::move(u)),
        weights(std::move(w)),
        workers(crew) {}
};

class ThinPlateLevel final : public LevelOperator {
 public:
  ThinPlateLevel(ThinPlateShared& shared, const Lattice& lattice) : shared_(shared), lattice_(lattice) {
    matrix_ = PlateMatrix::make(lattice, shared.stencils, shared.unknowns, shared.workers);
    update();
  }

  // Call after the weights have changed.
  void update() {
    if (matrix_) {
      matrix_->set_weights(shared_.weights);
      inverse_diagonal_ = matrix_->inverse_diagonal(shared_.workers);
      return;
    }
    inverse_diagonal_ = thin_plate_diagonal(lattice_, shared_.fine_rows, shared_.unknowns, shared_.weights,
                                            shared_.workers, shared_.fine_exchange);
    for (float& d : inverse_diagonal_) d = 1 / d;
  }

  std::size_t points() const override { return lattice_.size(); }
  std::size_t components() const override { return 3; }
  void apply(const double* x, double* y) override {
    apply_thin_plate(lattice_, shared_.fine_rows, shared_.unknowns, shared_.weights, shared_.workers,
                     shared_.fine_exchange, x, y);
  }
  void apply(const float* x, float* y) override {
    if (matrix_)
      return matrix_->visit_images(x, shared_.workers,
                                   [=](std::size_t first, std::size_t count, const float* image) {
                                     std::copy_n(image, 3 * count, y + 3 * first);
                                   });
    apply_thin_plate(lattice_, shared_.fast_rows, shared_.unknowns, shared_.weights, shared_.workers,
                     shared_.fast_exchange, x, y);
  }
  void relax(const SmoothingStep& step, Workers& workers) override {
    if (!matrix_) return LevelOperator::relax(step, workers);
    matrix_->visit_images(step.d, workers, [&](std::size_t first, std::size_t count, const float* image) {
      finish_step(step, 3, inverse_diagonal_.data(), first, count, image);
    });
  }
  void subtract_image(const float* x, float* room, float* y, Workers& workers) override {
    if (!matrix_) return LevelOperator::subtract_image(x, room, y, workers);
    matrix_->visit_images(x, workers, [=](std::size_t first, std::size_t count, const float* image) {
      for (std::size_t i = 0; i < 3 * count; ++i) y[3 * first + i] -= image[i];
    });
  }
  // Control vertices that move leave waves longer than a face.
  bool does_with_single() const override {
    return lattice_.n() <= most_of_single && !shared_.unknowns.any_vertex;
  }
  const Array<float>& inverse_diagonal() const override { return inverse_diagonal_; }
  AssembledSystem assemble() const override {
    return assemble_thin_plate(lattice_, shared_.stencils, shared_.unknowns, shared_.weights);
  }

 private:
  ThinPlateShared& shared_;
  const Lattice& lattice_;
  std::unique_ptr<PlateMatrix> matrix_;  // null: the passes serve
  Array<float> inverse_diagonal_;
};

class ThinPlateTransfer final : public LevelTransfer {
 public:
  ThinPlateTransfer(ThinPlateShared& shared, const Lattice& coarse, const Lattice& fine)
      : shared_(shared), coarse_(coarse), fine_(fine) {
    written_ = WrittenTransfer::make(coarse, fine, shared.stencils, shared.unknowns, shared.workers);
  }
  void prolong(const float* x, float* y) override {
    if (written_) return written_->prolong<3>(x, shared_.workers, y);
    fairing::prolong(coarse_, fine_, shared_.stencils, &shared_.unknowns, shared_.workers,
                     shared_.fast_exchange, x, y);
  }
  void restrict_to(const float* x, float* y) override {
    if (written_) return written_->restrict_to<3>(x, shared_.workers, y);
    fairing::restrict_to(coarse_, fine_, shared_.stencils, shared_.unknowns, shared_.workers,
                         shared_.fast_exchange, x, y);
  }
  // Null where the passes serve.
  const WrittenTransfer* written() const { return written_.get(); }

 private:
  ThinPlateShared& shared_;
  const Lattice &coarse_, &fine_;
  std::unique_ptr<WrittenTransfer> written_;
};

}  // namespace fairing
