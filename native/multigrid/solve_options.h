// SPDX-License-Identifier: GPL-3.0-or-later
// Accuracy and smoother of linear solves, as set by a caller, for either energy.
#pragma once

namespace fairing {

struct SolveOptions {
  // Conjugate gradients end when the residual relative to the control polyhedron's, and the
  // estimated error relative to the solution in the energy norm, are below this; 1e-13 to 0.5.
  double relative_residual = 1e-4;
  int max_iterations = 200;  // of each solve
  int smoother_degree = 0;   // Chebyshev's; 0: chosen by the solves
};

}  // namespace fairing
