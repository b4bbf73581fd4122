// SPDX-License-Identifier: GPL-3.0-or-later
// Prolongation by local quadratics and its transpose as rows, for levels of few points, where
// passes over faces and edges cost more than an index a number.
#pragma once

#include <memory>
#include <utility>

#include "sparse/matrix.h"
#include "sparse/ring_table.h"
#include "stencil/stencils.h"

namespace fairing {

// Neighbours of a vertex from which on the rows about it are more than a few per cent of all.
constexpr std::size_t large_ring = 64;

class AssembledTransfer {
 public:
  // Null where the passes are better (has_rows()), or columns are too many for 16 bits in one
  // place. Throws where the run has been cancelled.
  static std::unique_ptr<AssembledTransfer> make(const GridLevel& coarse, const GridLevel& fine,
                                                 const Stencils& stencils, const Unknowns& unknowns,
                                                 Workers& workers);

  // As prolong() and restrict_to() do on unknowns, with C numbers a point; the vector that is read
  // has `vector_room` more.
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
