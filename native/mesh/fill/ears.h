// SPDX-License-Identifier: GPL-3.0-or-later
// A ragged polygon in space made shorter: triangles in its sharpest corners.
#pragma once

#include <vector>

#include "mesh/fill/triangulate.h"

namespace fairing {

// What is left of a polygon.
struct Shortened {
  std::vector<Triangle> ears;  // corners, rising
  std::vector<Index> corners;  // that are left, in their order
  std::vector<Vec3> normals;   // of what is behind the side from each of these to the next
};

// Cuts off ears, the sharpest corner first, until `enough` corners are left or no ear is smooth: it
// must turn by less than 60 degrees against what is behind its two sides.
Shortened cut_ears(const SpacePolygon& polygon, std::size_t enough);

}  // namespace fairing
