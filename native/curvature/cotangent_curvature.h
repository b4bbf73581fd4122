// SPDX-License-Identifier: GPL-3.0-or-later
// Curvature of a ring by cotangents and angles [Meyer, Desbrun, Schroeder, Barr 2003]: less
// accurate than a fit (point_curvature.h), but bounded by the ring's own bending.
#pragma once

#include "curvature/point_curvature.h"

namespace fairing {

struct CotangentCurvature {
  double mean = 0;   // the integral of 2 H^2, (k1 + k2)^2 / 2, over the point's mixed area
  double gauss = 0;  // the integral of K: a full turn minus the sum of the angles
};

// For a closed ring. A quad counts as the mean of its two triangulations; triangles without an area
// count by their angle only. Sums are exact: over a closed surface `gauss` is 2 pi times its Euler
// characteristic. A ring that is not finite, or exceeds ring_farthest, has an infinite `mean`.
CotangentCurvature cotangent_curvature(const SurfaceRing& ring);

}  // namespace fairing
