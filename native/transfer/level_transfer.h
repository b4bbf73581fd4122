// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of unknowns between a level and the next coarser one, in single precision: what a
// multigrid cycle asks for.
#pragma once

#include <algorithm>

#include "transfer/quadratic.h"
#include "transfer/quadratic_matrix.h"

namespace fairing {

// The two are transposes of one another. Zero on points that are not unknowns. What is read has
// `vector_room` (multigrid/level_operator.h) more. Both throw where the run has been cancelled.
class LevelTransfer {
 public:
  virtual ~LevelTransfer() = default;
  virtual void prolong(const float* coarse, float* fine) = 0;
  virtual void restrict_to(const float* fine, float* coarse) = 0;
};

// Local quadratics, with C numbers a point: 3 coordinates, or 1 displacement. As a matrix where
// that is given, by passes over the faces elsewhere.
template <int C>
class QuadraticTransfer final : public LevelTransfer {
 public:
  // All must outlive the transfer. `matrix` may be null, or about more control vertices than
  // `unknowns`; `slots` may be shared by all levels.
  QuadraticTransfer(const GridLevel& coarse, const GridLevel& fine, const Stencils& stencils,
                    const Unknowns& unknowns, const AssembledTransfer* matrix, Workers& workers,
                    ElementSlots<float, C>& slots)
      : coarse_(coarse),
        fine_(fine),
        stencils_(stencils),
        unknowns_(unknowns),
        matrix_(matrix),
        workers_(workers),
        slots_(slots) {}

  void prolong(const float* x, float* y) override {
    if (matrix_) {
      matrix_->prolong<C>(x, workers_, y);
      return clear_fixed(y);
    }
    fairing::prolong(coarse_, fine_, stencils_, &unknowns_, workers_, slots_, x, y);
  }
  void restrict_to(const float* x, float* y) override {
    if (matrix_) {
      matrix_->restrict_to<C>(x, workers_, y);
      return clear_fixed(y);
    }
    fairing::restrict_to(coarse_, fine_, stencils_, unknowns_, workers_, slots_, x, y);
  }

 private:
  // Control vertices may have been fixed since the matrix was made.
  void clear_fixed(float* y) const {
    for (std::size_t v = 0; v < unknowns_.vertex.size(); ++v)
      if (!unknowns_.vertex[v]) std::fill_n(y + C * v, C, 0.0f);
  }

  const GridLevel &coarse_, &fine_;
  const Stencils& stencils_;
  const Unknowns& unknowns_;
  const AssembledTransfer* matrix_;
  Workers& workers_;
  ElementSlots<float, C>& slots_;
};

}  // namespace fairing
