// SPDX-License-Identifier: GPL-3.0-or-later
// Merges vertices. For mesh/mend/ only.
#pragma once

#include "mesh/polygon_mesh.h"
#include "mesh/union_find.h"

namespace fairing {

// Unites vertices of faces no farther apart than `distance`: each, by its id, with the lowest kept
// one that is near enough. So none moves farther than that. Returns whether there are any.
bool merge_near(const PolygonMesh& mesh, double distance, UnionFind& merges);

// Unites vertices of a face at one point, and the ends of a tiny side in a face without area.
// `mesh` has finite vertices in its faces. Returns whether there are any.
bool merge_within_faces(const PolygonMesh& mesh, UnionFind& merges);

}  // namespace fairing
