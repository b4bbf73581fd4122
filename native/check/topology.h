// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the faces form a manifold: no face twice, at most two faces an edge, one fan a vertex.
#pragma once

#include "check/half_edges.h"

namespace fairing {

// Throws FairingError duplicate_face (same vertex set, in whatever order) with all faces concerned.
void check_duplicate_faces(const PolygonMesh& mesh);

// Throws FairingError nonmanifold_edge (vertex pairs).
void check_edges(const HalfEdges& half_edges);

// Throws FairingError nonmanifold_vertex. Needs manifold edges; does not care about orientation.
void check_fans(const PolygonMesh& mesh, const HalfEdges& half_edges);

}  // namespace fairing
