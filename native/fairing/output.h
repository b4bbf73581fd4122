// SPDX-License-Identifier: GPL-3.0-or-later
// A surface on its way out: its faces, and its points in the caller's coordinates.
#pragma once

#include <cstdint>

#include "fairing/control_positions.h"
#include "grid/grid_level.h"
#include "parallel/memory.h"
#include "parallel/workers.h"

namespace fairing {

struct OutputFaces {
  // Ids of the welded surface's points, counter-clockwise: 3 a triangle, of the control triangles'
  // grids; 4 a quad, of the control quads' grids.
  Array<std::int32_t> triangles, quads;
  // The input face that each comes from.
  Array<std::int32_t> triangle_polygon, quad_polygon;
  // The face of the mended mesh that each comes from; empty where nothing was mended.
  Array<std::int32_t> triangle_mended{}, quad_mended{};
};

// The cells of every control face's grid, in the control faces' order, row by row. May throw
// FairingError(cancelled) and bad_alloc.
OutputFaces make_faces(const GridLevel& grid, Workers& workers);

// 2 vertex ids an edge: the control edges that became creases, by whatever rule, non-manifold ones
// among them.
Array<std::int32_t> crease_edges(const ControlMesh& mesh);

// world <- the surface x of working coordinates, both 3 numbers a point of the finest level; they
// may be the same array. Control vertices and points of curves that have not moved come back to the
// last bit: they are copied from `control`. What lies outside a region is refined linearly. May
// throw FairingError(cancelled).
void to_world(const ControlPositions& control, const GridLevel& grid, const Frame& frame,
              Workers& workers, const double* x, double* world);

// The farthest that one of the first `input_vertices` points of a surface is from where `given` has
// it; both in world coordinates.
double largest_deviation(const std::vector<Vec3>& cage, const double* world);

}  // namespace fairing
