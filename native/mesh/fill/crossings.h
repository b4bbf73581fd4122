// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles that pass through others.
#pragma once

#include <span>
#include <vector>

#include "mesh/fill/triangulate.h"

namespace fairing {

// Those of `triangles` (of indices in `points`) from the `first` on that meet another one in more than
// a point, or lie on one another, ascending. Of two that share a vertex nothing is asked.
std::vector<std::size_t> crossing(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                  std::size_t first);

}  // namespace fairing
