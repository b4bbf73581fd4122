// SPDX-License-Identifier: GPL-3.0-or-later
// Prolongation of surfaces by their normals, where local quadratics overshoot.
#pragma once

#include "grid/grid_level.h"
#include "parallel/workers.h"

namespace fairing {

// fine <- coarse, with new points as the normals at the ends of their edge prescribe (a quad's
// centre: both diagonals): the midpoints of curved PN triangles [Vlachos, Peters, Boyd, Mitchell
// 2001]. It does not overshoot, and spacing is that of straight edges, so it is a safe start where
// local quadratics in the control metric would wrinkle. Exact to fourth order. With unit normals m,
// n at a and b, the midpoint is
//
//   (a + b)/2 - ((b - a) . m) m / 8 + ((b - a) . n) n / 8.
//
// 3 numbers a point; a zero normal has no bulge. Throws FairingError(cancelled).
void prolong_with_normals(const GridLevel& coarse, const GridLevel& fine, Workers& workers,
                          const double* x, const double* normal, double* x_fine);

}  // namespace fairing
