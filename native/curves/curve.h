// SPDX-License-Identifier: GPL-3.0-or-later
// One feature curve in closed form. It depends only on its own vertices, so meshes that share a
// curve have it bit for bit.
#pragma once

#include <span>
#include <vector>

#include "base/types.h"
#include "curves/lines.h"

namespace fairing {

// The second difference at the ends of an open chain of three vertices or more.
enum class ChainEnds {
  natural,    // zero, as the boundary of a Catmull-Clark surface has it at corners
  parabolic,  // as at the next vertex: zero would flatten the ends of a curve through measured points
};

struct CurveScheme {
  int subdivisions;  // pieces an edge
  double exponent;   // of the chord length
  ChainEnds ends = ChainEnds::parabolic;
};

// Points of a refined chain: the minimizer of the squared second divided differences with respect to
// (chord length)^exponent, through the chain's vertices [Kobbelt 1996, §3], periodic on a loop; with
// parabolic ends the second difference is constant in the first and in the last segment. Lines that are
// tangent to arcs stay straight, and the arcs have their directions (curves/lines.h).
//
// Returns, edge by edge along the chain, the subdivisions - 1 interior points of each edge, in the
// chain's direction. The result depends on the coordinates alone, not on numbering, direction or
// first vertex: equal polylines give bit-identical points.
//
// The chord lengths and the order are those of `parameters`, which may be `vertices` themselves; with
// others, the result is linear in `vertices`. `beyond`, among the parameters, decides on lines alone.
std::vector<Vec3> refine_chain(std::span<const Vec3> parameters, std::span<const Vec3> vertices,
                               bool closed, const CurveScheme& scheme, Beyond beyond = {});

}  // namespace fairing
