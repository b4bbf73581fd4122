// SPDX-License-Identifier: GPL-3.0-or-later
// Prolongation of surfaces by their normals, where local quadratics overshoot.
#pragma once

#include "grid/grid_level.h"
#include "parallel/workers.h"

namespace fairing {

// fine <- coarse, where new points bulge as the normals at the ends of their edge have it (a quad's
// centre: of both diagonals): the midpoints of curved PN triangles [Vlachos, Peters, Boyd, Mitchell
// 2001]. Nothing overshoots, and spacing is that of straight edges: a safe start where local
// quadratics in the control metric make a wrinkled one. Exact to fourth order. With unit normals m,
// n at a and b, the midpoint is
//
//   (a + b)/2 - ((b - a) . m) m / 8 + ((b - a) . n) n / 8.
//
// 3 numbers a point; a normal of zero bulges nothing. Throws where the run has been cancelled.
void prolong_with_normals(const GridLevel& coarse, const GridLevel& fine, Workers& workers,
                          const double* x, const double* normal, double* x_fine);

}  // namespace fairing
