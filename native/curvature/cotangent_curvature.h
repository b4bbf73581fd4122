// SPDX-License-Identifier: GPL-3.0-or-later
// Curvature of a ring by cotangents and angles [Meyer, Desbrun, Schroeder, Barr 2003]: coarser than
// a fit (point_curvature.h), but it says no more than the ring bends, however thin its triangles are.
#pragma once

#include "curvature/point_curvature.h"

namespace fairing {

struct CotangentCurvature {
  double mean = 0;   // the integral of 2 H^2, (k1 + k2)^2 / 2, over the point's mixed area
  double gauss = 0;  // the integral of K: what the angles lack of a full turn
};

// Of a closed ring. A quad counts as the mean of its two triangulations, triangles without an area
// have an angle alone. Exact in sums: over a closed surface `gauss` adds up to 2 pi times its Euler
// characteristic. A ring that is not finite, or beyond ring_farthest, has an infinite `mean`.
CotangentCurvature cotangent_curvature(const SurfaceRing& ring);

}  // namespace fairing
