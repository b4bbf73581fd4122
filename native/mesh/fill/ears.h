// SPDX-License-Identifier: GPL-3.0-or-later
// Shortens a ragged polygon in space by triangles in its sharpest corners.
#pragma once

#include <vector>

#include "mesh/fill/triangulate.h"

namespace fairing {

// The rest of a polygon.
struct Shortened {
  std::vector<Triangle> ears;  // corners, ascending
  std::vector<Index> corners;  // the remaining ones, in their order
  std::vector<Vec3> normals;   // of the face behind the side from each of these to the next
};

// Cuts off ears, the sharpest corner first, until `enough` corners are left: first those that turn
// by less than 60 degrees against the faces behind their two sides, then any. More corners are left
// only where no ear has an area and an allowed third side.
Shortened cut_ears(const SpacePolygon& polygon, std::size_t enough);

}  // namespace fairing
