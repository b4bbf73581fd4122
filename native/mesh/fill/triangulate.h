// SPDX-License-Identifier: GPL-3.0-or-later
// The first triangles over a hole, without new vertices [Barequet and Sharir 1995; Liepa 2003].
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "base/types.h"

namespace fairing {

// A closed polygon in space. Corners may coincide if a hole has islands.
struct SpacePolygon {
  std::vector<Vec3> points;
  // Unit normals of the faces beyond the side from each corner to the next; zero: none.
  std::vector<Vec3> normals;
  // Whether two corners that are not neighbours may be joined; called with (low, high).
  std::function<bool(std::size_t, std::size_t)> may_join;
};

using Triangle = std::array<Index, 3>;

// Triangles of corners with the polygon's orientation: those that fold least, summed over all
// edges, those beyond the sides included; among these with the least largest angle between
// neighbours, and then with the least area. Empty if the allowed pairs give no triangulation. By
// dynamic programming over all pairs of corners, cubic in their number; of more than some hundreds
// the sharpest corners are cut off first; empty too if too many are left.
std::vector<Triangle> triangulate(const SpacePolygon& polygon);

}  // namespace fairing
