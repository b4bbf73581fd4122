// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "execution/workers.h"
#include "lattice/lattice.h"

namespace fairing {

// fine <- coarse, where new points bulge as the normals at the ends of their edge have it (a quad's centre: of both
// diagonals): the midpoints of curved PN triangles [Vlachos, Peters, Boyd, Mitchell 2001]. Nothing overshoots, and spacing
// is that of straight edges: a safe start where local quadratics in the control metric make a wrinkled one. Exact to
// fourth order. 3 numbers a point; a normal of zero bulges nothing.
void prolong_with_normals(const Lattice& coarse, const Lattice& fine, Workers& workers, const double* x,
                          const double* normal, double* x_fine);

}  // namespace fairing
