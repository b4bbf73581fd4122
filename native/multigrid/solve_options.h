// SPDX-License-Identifier: GPL-3.0-or-later
// How far linear systems are solved, and by which smoother: as a caller sets it, for either energy.
#pragma once

namespace fairing {

struct SolveOptions {
  // Where conjugate gradients end: the residual relative to the control polyhedron's, and the
  // estimated error relative to the solution in the energy norm; 1e-13 to 0.5.
  double relative_residual = 1e-4;
  int max_iterations = 200;  // of each solve
  int smoother_degree = 0;   // Chebyshev's; 0: chosen from how the solves go
};

}  // namespace fairing
