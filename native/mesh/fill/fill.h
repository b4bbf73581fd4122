// SPDX-License-Identifier: GPL-3.0-or-later
// Fills holes with new triangles. Existing elements do not change; new vertices and faces follow
// them.
//
// All functions here may throw FairingError(cancelled) and std::bad_alloc.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/fill/holes.h"
#include "mesh/fill/refine.h"

namespace fairing {

struct FillOptions {
  // Edges of the rim over new edges: 1 as long, 2 half as long. 0: no new vertices, if possible.
  double density = 1;
  // Whether a filling continues the faces around, or only the rim.
  bool bends = true;
};

// The loop around a hole and those of its islands, in any order, each oriented as by find_holes().
using Hole = std::vector<HoleLoop>;

// The new faces of one hole: triangles of vertex ids. Ids from the mesh's number of vertices on are
// the hole's own, and follow those of the hole before.
struct FilledHole {
  std::vector<Vec3> points;     // of its own vertices
  std::vector<double> lengths;  // of edges requested at each
  std::vector<Triangle> triangles;
};

// Per hole, why it is not filled, if so.
using Refusals = std::vector<std::optional<FairingError>>;

// Orients and orders the loops as find_holes() does, from any direction, order and start, and says
// for each hole why it is not one of this mesh: repeated_vertex, nonmanifold_edge,
// inconsistent_orientation, too_large, bad_option. Throws FairingError for loops of fewer than
// three vertices (bad_option) and for missing vertices (index_out_of_range).
Refusals check_holes(const PolygonMesh& mesh, const HalfEdges& half_edges,
                     std::vector<Hole>& holes);

// Fills checked holes, one after another, except refused ones: earlier, or here if only faces
// without area would fit, islands cannot be joined to the rim, or the result would be too_large.
// One entry for each filled hole.
std::vector<FilledHole> fill(const PolygonMesh& mesh, const HalfEdges& half_edges,
                             std::span<const Hole> holes, const FillOptions& options,
                             Refusals& refusals);

// Fills the `chosen` holes (one flag each) again, after their vertices have been moved: they get
// triangles that fit the new shape, which is treated as a smooth surface between its vertices if it
// is `fair` (flags too). All vertices are numbered again.
void refine_again(const PolygonMesh& mesh, const HalfEdges& half_edges, std::span<const Hole> holes,
                  const FillOptions& options, std::span<const std::uint8_t> chosen,
                  std::span<const std::uint8_t> fair, std::vector<FilledHole>& filled);

}  // namespace fairing
