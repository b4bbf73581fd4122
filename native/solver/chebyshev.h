// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "execution/workers.h"
#include "solver/level_operator.h"

namespace fairing {

// Vectors of one level that the smoother works on.
struct SmootherState {
  Array<float> x, residual, step, next;
  void resize(std::size_t size) {
    x.resize(size + vector_room);
    residual.resize(size + vector_room);
    step.resize(size + vector_room);
    next.resize(size + vector_room);
  }
};

// What a smoother starts from.
enum class SmoothFrom {
  zero,        // x is set
  correction,  // state.step is still to be added to x, and K times it to be taken from the residual
};

// `degree` steps of Chebyshev iteration of the fourth kind on D^-1 K [Lottes 2022; Phillips & Fischer 2022]: it needs
// the largest eigenvalue only. Updates x, and the residual with it unless `last_residual` is false (then the residual
// is stale, and one application of K saved).
void smooth(LevelOperator& op, Workers& workers, double largest_eigenvalue, int degree, SmoothFrom from,
            bool last_residual, SmootherState& state);

// The vectors' part of a step, on the points from `first` on: image is K d there.
void finish_step(const SmoothingStep& step, std::size_t components, const float* inverse_diagonal,
                 std::size_t first, std::size_t count, const float* image);

}  // namespace fairing
