// SPDX-License-Identifier: GPL-3.0-or-later
// Whether neighbouring faces agree on which side is out.
#pragma once

#include "check/half_edges.h"

namespace fairing {

// The faces (ascending) that must turn over for all neighbours to agree: in each component the smaller party;
// where both are equal, the one that does not hold the component's first face.
// Throws FairingError non_orientable with all faces of the one-sided components.
std::vector<std::int64_t> disagreeing_faces(const PolygonMesh& mesh, const HalfEdges& half_edges);

}  // namespace fairing
