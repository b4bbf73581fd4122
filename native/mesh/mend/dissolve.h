// SPDX-License-Identifier: GPL-3.0-or-later
// Removes faces without area without leaving T-junctions. For mesh/mend/ only.
#pragma once

#include <span>
#include <vector>

#include "mesh/mend/loops.h"

namespace fairing {

struct Dissolved {
  std::vector<std::int64_t> faces;  // of the input, ascending: removed or cut
  std::vector<CutEdge> cut_edges;   // ascending
};

// Removes faces whose vertices are on one line: if a vertex of such a face is inside one of its
// sides, the faces across that side get it between their corners. A face without area that crosses
// itself is cut into triangles. Cases that would not end are left to check().
Dissolved dissolve_flat_faces(std::span<const double> coordinates, Loops& loops);

}  // namespace fairing
