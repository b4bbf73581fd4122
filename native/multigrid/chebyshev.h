// SPDX-License-Identifier: GPL-3.0-or-later
// The smoother, and the one number that it needs.
#pragma once

#include "multigrid/level_operator.h"
#include "multigrid/line_jacobi.h"

namespace fairing {

// Vectors of one level that the smoother works on.
struct SmootherState {
  // `residual` is b - K x before `step` is taken from it; `step` the last change of x; `next` the
  // room for the one to come.
  Array<float> x, residual, step, next;
  void resize(std::size_t size) {
    for (Array<float>* v : {&x, &residual, &step, &next}) v->resize(size + vector_room);
  }
};

// What a smoother starts from.
enum class SmoothFrom {
  zero,        // x is set
  correction,  // state.step is still to be added to x, and K times it to be taken from the residual
};

// `degree` steps of Chebyshev iteration of the fourth kind on D^-1 K [Lottes 2022; Phillips &
// Fischer 2022]: with lambda the largest eigenvalue of D^-1 K,
//
//   z_k = (2k - 1)/(2k + 3) z_{k-1} + (8k + 4)/(2k + 3)/lambda D^-1 r_k,  x += z_k,  z_{-1} = 0.
//
// No lower end of the spectrum has to be guessed. `lines`, which may be null, join D. Updates x, and
// the residual with it unless `last_residual` is false (then the residual is stale, and one application
// of K saved).
void smooth(LevelOperator& op, const LineJacobi* lines, Workers& workers, double largest_eigenvalue,
            int degree, SmoothFrom from, bool last_residual, SmootherState& state);

// The vectors' part of a step, for `count` points from `first` on: product is K d there, the
// vectors of `step` begin at point 0.
void finish_step(const SmoothingStep& step, std::size_t components, const float* inverse_diagonal,
                 std::size_t first, std::size_t count, const float* product);

// The largest eigenvalue of D^-1 K, where `lines` join D, by a few Lanczos steps from `start` (a safe
// margin included). A start that moves with the mesh, such as a residual, makes the estimate independent
// of numbering and position.
double largest_eigenvalue(LevelOperator& op, const LineJacobi* lines, Workers& workers,
                          const float* start);

}  // namespace fairing
