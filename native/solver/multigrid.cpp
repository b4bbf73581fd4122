// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/multigrid.h"

namespace fairing {

void VCycle::run(std::size_t top) {
  CycleLevel& level = levels[top];
  if (top == base) {
    coarse->solve(level.largest_eigenvalue, degree, level.state);
    return;
  }
  SmootherState& s = level.state;
  smooth(*level.op, workers_, level.largest_eigenvalue, degree, SmoothFrom::zero, true, s);
  level.transfer->restrict_to(s.residual.data(), levels[top - 1].state.residual.data());
  run(top - 1);
  level.transfer->prolong(levels[top - 1].state.x.data(), s.step.data());
  smooth(*level.op, workers_, level.largest_eigenvalue, degree, SmoothFrom::correction, false, s);
}

}  // namespace fairing
