// SPDX-License-Identifier: GPL-3.0-or-later
// Faces without area go, and leave no T-junction. For mesh/mend/ only.
#pragma once

#include <span>
#include <vector>

#include "mesh/mend/loops.h"

namespace fairing {

struct Dissolved {
  std::vector<std::int64_t> faces;  // of the input, ascending: those that went or were cut
  std::vector<CutEdge> cut_edges;   // ascending
};

// A face whose vertices lie on one line goes: where a vertex of it lies inside one of its sides,
// the faces across that side get it between their corners. A face without area that crosses itself
// is cut into triangles. What would take for ever is left to check().
Dissolved dissolve_flat_faces(std::span<const double> coordinates, Loops& loops);

}  // namespace fairing
