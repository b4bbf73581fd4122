// SPDX-License-Identifier: GPL-3.0-or-later
// The orientable double cover of one-sided sheets, such as a Möbius strip: every face twice, the
// second time reversed, and the vertices twice, so that each face agrees with its neighbours. It
// has two sides everywhere, and is the sheet itself around every point. Both halves come out the
// same.
#pragma once

#include <vector>

#include "mesh/half_edges.h"
#include "mesh/split.h"

namespace fairing {

struct DoubleCover {
  bool empty() const { return one_sided.empty(); }
  bool has(std::int32_t polygon) const { return !empty() && one_sided[std::size_t(polygon)]; }

  std::vector<std::uint8_t> one_sided;  // polygons. Empty: all sheets have two sides
  std::vector<Index> over;              // the other vertex at the same place; -1: none
  std::vector<std::uint8_t> turned;     // corners whose face runs against the first of their fan
};

// Which polygons need one; its vertices are still to be made (mesh/sheets.cpp).
DoubleCover begin_double_cover(const PolygonMesh& mesh, const HalfEdges& half_edges);

// Replaces the faces and centres of one-sided sheets by their covers'. The first halves keep their
// places, the second ones are added behind all others. Returns the faces that these repeat.
std::vector<Index> lift_faces(const PolygonMesh& mesh, const DoubleCover& cover, SplitMesh& split,
                              std::vector<Index>& copied_centres);

}  // namespace fairing
