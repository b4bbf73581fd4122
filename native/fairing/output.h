// SPDX-License-Identifier: GPL-3.0-or-later
// The output of a surface: its faces, and its points in the caller's coordinates.
#pragma once

#include <cstdint>

#include "fairing/control_positions.h"
#include "grid/grid_level.h"
#include "parallel/memory.h"
#include "parallel/workers.h"

namespace fairing {

struct OutputFaces {
  // Ids of the welded surface's points, counter-clockwise: 3 per triangle, from the grids of
  // control triangles; 4 per quad, from those of control quads.
  Array<std::int32_t> triangles, quads;
  // The input face of each.
  Array<std::int32_t> triangle_polygon, quad_polygon;
  // The face of the mended mesh of each; empty if nothing was mended.
  Array<std::int32_t> triangle_mended{}, quad_mended{};
};

// The cells of every control face's grid, in the control faces' order, row by row. May throw
// FairingError(cancelled) and bad_alloc.
OutputFaces make_faces(const GridLevel& grid, Workers& workers);

// 2 vertex ids per edge: the control edges that became creases, non-manifold ones included.
Array<std::int32_t> crease_edges(const ControlMesh& mesh);

// world <- the surface x of working coordinates, both 3 numbers a point of the finest level; they
// may be the same array. Control vertices and curve points that have not moved are copied from
// `control`, bit for bit. The outside of a region is refined linearly. May throw
// FairingError(cancelled).
void to_world(const ControlPositions& control, const GridLevel& grid, const Frame& frame,
              Workers& workers, const double* x, double* world);

// Largest distance between the first points of a surface and `cage`, in world coordinates.
double largest_deviation(const std::vector<Vec3>& cage, const double* world);

}  // namespace fairing
