// SPDX-License-Identifier: GPL-3.0-or-later
// One feature curve in closed form. It depends only on its own vertices, so meshes that share a
// curve have it bit for bit.
#pragma once

#include <span>
#include <vector>

#include "base/types.h"

namespace fairing {

// Points of a chain refined into `subdivisions` pieces an edge: the minimizer of the squared second
// divided differences with respect to (chord length)^exponent, through the chain's vertices
// [Kobbelt 1996, §3], periodic on a loop; in the first and the last segment of an open chain of three
// vertices and more the second difference is constant, since zero at its ends would flatten them.
//
// Returns, edge by edge along the chain, the subdivisions - 1 interior points of each edge, in the
// chain's direction. The result depends on the coordinates alone, not on numbering, direction or
// first vertex: equal polylines give bit-identical points.
std::vector<Vec3> refine_chain(std::span<const Vec3> vertices, bool closed, int subdivisions,
                               double exponent);

// The same through `vertices`, with the chord lengths and the order of `parameters`: linear in
// `vertices`.
std::vector<Vec3> refine_chain(std::span<const Vec3> parameters, std::span<const Vec3> vertices,
                               bool closed, int subdivisions, double exponent);

}  // namespace fairing
