// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "execution/workers.h"
#include "solver/level_operator.h"

namespace fairing {

// Vectors of one level that the smoother works on.
struct SmootherState {
  Array<float> x, residual, step, image;
  void resize(std::size_t size) {
    x.resize(size);
    residual.resize(size);
    step.resize(size);
    image.resize(size);
  }
};

// `degree` steps of Chebyshev iteration of the fourth kind on D^-1 K [Lottes 2022; Phillips & Fischer 2022]: it needs
// the largest eigenvalue only. Updates x, and the residual with it unless `last_residual` is false (then the residual
// is stale, and one application of K saved). With `from_zero` x is set, not updated.
void smooth(LevelOperator& op, Workers& workers, double largest_eigenvalue, int degree, bool from_zero,
            bool last_residual, SmootherState& state);

}  // namespace fairing
