// SPDX-License-Identifier: GPL-3.0-or-later
// The first triangles over a hole, without new vertices [Barequet and Sharir 1995; Liepa 2003].
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "base/types.h"

namespace fairing {

// A closed polygon in space. Places may lie at one point, where a hole has islands.
struct SpacePolygon {
  std::vector<Vec3> points;
  // Of unit length, of the face beyond the side from each corner to the next; zero: there is none.
  std::vector<Vec3> normals;
  // Whether two corners that are no neighbours may be joined; called with (low, high).
  std::function<bool(std::size_t, std::size_t)> may_join;
};

using Triangle = std::array<Index, 3>;

// Triangles of corners, running as the polygon does: those that fold least, summed over all edges,
// those beyond the sides included; among these of the least largest angle between neighbours, and
// then of the least area. Empty where the corners that may be joined allow none. By dynamic
// programming over all pairs of corners, cubic in their number; of more than some hundreds the
// sharpest corners are cut off first (ears.h), and then only pairs far apart count that are also
// corners of a coarser polygon, so that the work is linear.
std::vector<Triangle> triangulate(const SpacePolygon& polygon);

}  // namespace fairing
