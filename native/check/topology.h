// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the faces form a manifold: no face twice, at most two faces an edge, one fan a vertex.
#pragma once

#include "check/defect.h"
#include "check/half_edges.h"

namespace fairing {

// Adds duplicate_face (same vertex set, in whatever order) with all faces concerned.
void check_duplicate_faces(const PolygonMesh& mesh, Defects& found);

// Adds nonmanifold_edge (vertex pairs).
void check_edges(const HalfEdges& half_edges, Defects& found);

// Adds nonmanifold_vertex; does not care about orientation. Ends of nonmanifold edges are left out: there the edge is
// the defect.
void check_fans(const PolygonMesh& mesh, const HalfEdges& half_edges, Defects& found);

}  // namespace fairing
