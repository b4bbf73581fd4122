// SPDX-License-Identifier: GPL-3.0-or-later
// The holes of a mesh: closed walks along edges that have one face.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/half_edges.h"

namespace fairing {

// Vertex ids around a hole, which lies on the left: a face that fills it runs the same way. No
// vertex comes twice.
using HoleLoop = std::vector<std::int64_t>;

// All of them, each from its least vertex on, in ascending order of these. A walk that touches
// itself in a vertex is cut there. Walks that meet an edge of more than two faces, or faces that
// disagree on which way they look, end nowhere, and are left out; so is the border of a face that
// is a sheet alone. The mesh must have passed require_arrays (mesh/validate/check.h).
std::vector<HoleLoop> find_holes(const PolygonMesh& mesh, const HalfEdges& half_edges);

}  // namespace fairing
