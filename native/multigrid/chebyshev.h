// SPDX-License-Identifier: GPL-3.0-or-later
// The smoother, and the eigenvalue that it needs.
#pragma once

#include "multigrid/level_operator.h"
#include "multigrid/line_jacobi.h"

namespace fairing {

// The smoother's vectors of one level.
struct SmootherState {
  // `residual` is b - K x before `step` is subtracted; `step` the last change of x; `next` a buffer
  // for the next one.
  Array<float> x, residual, step, next;
  void resize(std::size_t size) {
    for (Array<float>* v : {&x, &residual, &step, &next}) v->resize(size + vector_room);
  }
};

// The start of a smoother.
enum class SmoothFrom {
  zero,        // x is set
  correction,  // state.step is still to be added to x, and K times it subtracted from the residual
};

// `degree` steps of Chebyshev iteration of the fourth kind on D^-1 K [Lottes 2022; Phillips &
// Fischer 2022]: with lambda the largest eigenvalue of D^-1 K,
//
//   z_k = (2k - 1)/(2k + 3) z_{k-1} + (8k + 4)/(2k + 3)/lambda D^-1 r_k,  x += z_k,  z_{-1} = 0.
//
// No lower end of the spectrum is needed. `lines`, which may be null, extend D. Updates x, and the
// residual unless `last_residual` is false (then the residual is stale, which saves one product
// with K).
void smooth(LevelOperator& op, const LineJacobi* lines, Workers& workers, double largest_eigenvalue,
            int degree, SmoothFrom from, bool last_residual, SmootherState& state);

// The largest eigenvalue of D^-1 K, D extended by `lines`, by a few Lanczos steps from `start`
// (with a safety margin). A start that moves with the mesh, such as a residual, makes the estimate
// independent of numbering and position.
double largest_eigenvalue(LevelOperator& op, const LineJacobi* lines, Workers& workers,
                          const float* start);

}  // namespace fairing
