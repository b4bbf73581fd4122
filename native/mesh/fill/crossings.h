// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles that cross others.
#pragma once

#include <span>
#include <vector>

#include "mesh/fill/triangulate.h"

namespace fairing {

// Those of `triangles` (of indices in `points`) from `first` on that meet another one in more than
// a point, or overlap, ascending. Pairs that share a vertex are not tested.
std::vector<std::size_t> crossing(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                  std::size_t first);

}  // namespace fairing
