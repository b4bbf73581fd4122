// SPDX-License-Identifier: GPL-3.0-or-later
// The true total curvature of a refined surface, the integral of k1^2 + k2^2: in the surface's own
// metric, however it was found. 8 pi on any sphere; the thin-plate energy is its stand-in in the
// control metric.
#pragma once

#include <vector>

#include "grid/grid_level.h"
#include "parallel/workers.h"

namespace fairing {

// By cotangents and angles (cotangent_curvature.h), with k1^2 + k2^2 = 4 H^2 - 2 K: not by the fits
// of the Gauss-Newton steps, which say many times too much where triangles are thin. Over the points
// that carry a fit: not those of curves and corners, nor of a boundary in any mode; so the half
// cells along these count for nothing. x: 3 numbers a point.
//
// Second order in the spacing on a smooth closed surface. On a mesh inscribed in a sphere, where
// the polyhedron's area lets H fall short of K, k1^2 + k2^2 is not taken below 2 H^2. Finite for any
// finite x. Bit-identical for any number of threads.
double total_curvature(const GridLevel& grid, Workers& workers, const double* x);

}  // namespace fairing
