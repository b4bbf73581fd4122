// SPDX-License-Identifier: GPL-3.0-or-later
// Prolongation by local quadratics and its transpose as rows, for levels of few points, where
// passes over faces and edges cost more than an index for each number.
#pragma once

#include <memory>
#include <utility>

#include "sparse/matrix.h"
#include "sparse/ring_table.h"
#include "stencil/stencils.h"

namespace fairing {

// From this valence on the rows around a vertex are more than a few per cent of all.
constexpr std::size_t large_ring = 64;

class AssembledTransfer {
 public:
  // Null if passes are faster (has_rows()), or if a chunk has too many columns for 16 bits. Throws
  // FairingError(cancelled).
  static std::unique_ptr<AssembledTransfer> make(const GridLevel& coarse, const GridLevel& fine,
                                                 const Stencils& stencils, const Unknowns& unknowns,
                                                 Workers& workers);

  // As prolong() and restrict_to() on unknowns, with C numbers a point; the input vector has
  // `vector_room` extra numbers.
  template <int C>
  void prolong(const float* coarse, Workers& workers, float* fine) const {
    prolongation_->apply<C>(coarse, workers, fine);
  }
  template <int C>
  void restrict_to(const float* fine, Workers& workers, float* coarse) const {
    restriction_->apply<C>(fine, workers, coarse);
  }

 private:
  using Matrix = std::unique_ptr<const AssembledMatrix>;
  AssembledTransfer(Matrix prolongation, Matrix restriction)
      : prolongation_(std::move(prolongation)), restriction_(std::move(restriction)) {}

  const Matrix prolongation_, restriction_;
};

}  // namespace fairing
