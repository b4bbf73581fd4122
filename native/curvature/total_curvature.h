// SPDX-License-Identifier: GPL-3.0-or-later
// The true total curvature of a refined surface, the integral of k1^2 + k2^2 in the surface's own
// metric, whichever method computed it. It is 8 pi on any sphere. The thin-plate energy
// approximates it in the control metric.
#pragma once

#include <vector>

#include "grid/grid_level.h"
#include "parallel/workers.h"

namespace fairing {

// By cotangents and angles, with k1^2 + k2^2 = 4 H^2 - 2 K. The fits of the
// Gauss-Newton steps are not used, since they overestimate it many times where triangles are thin.
// The sum is over points with a fit: not those of curves, corners and boundaries in any mode, so
// the half cells along these do not count. x: 3 numbers a point.
//
// Second order in the spacing on a smooth closed surface. On a mesh inscribed in a sphere, the area
// of the polyhedron makes H^2 less than K, so k1^2 + k2^2 is taken as 2 H^2 at least. Finite for
// any finite x. Bit-identical for any number of threads.
double total_curvature(const GridLevel& grid, Workers& workers, const double* x);

}  // namespace fairing
