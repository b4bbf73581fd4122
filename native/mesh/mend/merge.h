// SPDX-License-Identifier: GPL-3.0-or-later
// Which vertices become one. For mesh/mend/ only.
#pragma once

#include "mesh/polygon_mesh.h"
#include "mesh/union_find.h"

namespace fairing {

// Unites vertices of faces no farther apart than `distance`: each, by its id, with the lowest that
// is kept and near enough. So none moves farther than that. Returns whether there are such.
bool weld(const PolygonMesh& mesh, double distance, UnionFind& merges);

// Unites vertices of a face at one point, and the ends of a side that is next to nothing in a face
// without area. `mesh` has finite vertices in its faces. Returns whether there are such.
bool merge_within_faces(const PolygonMesh& mesh, UnionFind& merges);

}  // namespace fairing
