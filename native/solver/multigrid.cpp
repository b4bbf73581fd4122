// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/multigrid.h"

#include "execution/vectors.h"

namespace fairing {

void VCycle::run(std::size_t top) {
  CycleLevel& level = levels[top];
  monitor_.check_cancelled();
  if (top == base) {
    coarse->solve(level.largest_eigenvalue, degree, level.state);
    return;
  }
  SmootherState& s = level.state;
  smooth(*level.op, workers_, level.largest_eigenvalue, degree, true, true, s);
  level.transfer->restrict_to(s.residual.data(), levels[top - 1].state.residual.data());
  run(top - 1);
  level.transfer->prolong(levels[top - 1].state.x.data(), s.step.data());
  monitor_.check_cancelled();
  level.op->apply(s.step.data(), s.image.data());
  for_each_index(workers_, level.op->size(), [&](std::size_t i) {
    s.x[i] += s.step[i];
    s.residual[i] -= s.image[i];
  });
  smooth(*level.op, workers_, level.largest_eigenvalue, degree, false, false, s);
}

}  // namespace fairing
