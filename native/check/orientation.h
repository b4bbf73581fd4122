// SPDX-License-Identifier: GPL-3.0-or-later
// Whether neighbouring faces agree on which side is out.
#pragma once

#include "check/defect.h"
#include "check/half_edges.h"

namespace fairing {

struct Orientation {
  // The faces (ascending) that must turn over for all neighbours to agree: in each component the smaller party;
  // where both are equal, the one that does not hold the component's first face.
  std::vector<std::int64_t> to_flip;
  std::vector<std::int64_t> one_sided;  // all faces (ascending) of components that cannot agree
};

Orientation find_orientation(const PolygonMesh& mesh, const HalfEdges& half_edges);

// Adds non_orientable and inconsistent_orientation, the latter as a warning where it will be repaired.
void check_orientation(const Orientation& orientation, bool repair, Defects& found);

}  // namespace fairing
