// SPDX-License-Identifier: GPL-3.0-or-later
// Folds of a refined surface: edges across which the normals of the triangles turn by more than 90
// degrees. Both diagonals of a quad are considered.
#pragma once

#include "grid/grid_level.h"
#include "parallel/memory.h"
#include "parallel/workers.h"

namespace fairing {

// Numbers of folded edges inside control faces and on control edges.
struct Folds {
  std::vector<std::uint32_t> in_face, on_edge;

  std::size_t count() const;
};

// Folds of the surface x (3 numbers a point). Edges of curves, which are creases, do not count, nor
// do edges outside the region, and edges in or next to control faces that are `excused`.
Folds find_folds(const GridLevel& grid, Workers& workers, const double* x,
                 const std::vector<std::uint8_t>& excused);

// The control faces at folds of the control mesh itself, for either diagonal of its quads; every
// surface through its vertices folds there. `cosine`: from this turn on an edge is a fold.
std::vector<std::uint8_t> folded_control_faces(const ControlMesh& mesh,
                                               std::span<const Vec3> control, Workers& workers,
                                               double cosine = 0);

// 1 at the ends of the folded edges, 0 elsewhere.
void mark_folds(const GridLevel& grid, const double* x, const Folds& folds, Array<float>& marks);

}  // namespace fairing
