// SPDX-License-Identifier: GPL-3.0-or-later
// The orientable double cover of one-sided sheets, such as a Möbius strip: every face twice, the
// second time reversed, and every vertex twice, so that each face agrees with its neighbours. It
// has two sides, and around each point it equals the sheet. Both halves have the same surface.
#pragma once

#include <vector>

#include "mesh/half_edges.h"
#include "mesh/split.h"

namespace fairing {

struct DoubleCover {
  bool empty() const { return one_sided.empty(); }
  bool has(std::int32_t polygon) const { return !empty() && one_sided[polygon]; }

  std::vector<std::uint8_t> one_sided;  // per polygon; empty: all sheets have two sides
  std::vector<Index> over;              // the other vertex at the same place; -1: none
  std::vector<std::uint8_t> turned;     // per corner: its face runs against the first of the fan
};

// Finds the polygons that need one; their second vertices are made in mesh/sheets.cpp.
DoubleCover begin_double_cover(const PolygonMesh& mesh, const HalfEdges& half_edges);

// Replaces the faces and centres of one-sided sheets by those of their covers. First halves keep
// their places; second halves follow all others. Returns the faces that these repeat.
std::vector<Index> lift_faces(const PolygonMesh& mesh, const DoubleCover& cover, SplitMesh& split,
                              std::vector<Index>& copied_centres);

}  // namespace fairing
