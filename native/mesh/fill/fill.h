// SPDX-License-Identifier: GPL-3.0-or-later
// Closes holes with new triangles. What was there stays: new vertices and faces are numbered on.
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
  // New edges are so many times as short as those of the rim: 1 as long, 2 half as long. 0: no new
  // vertices, where the hole can do without.
  double density = 1;
  // Whether a filling goes on from the faces around, or only from the rim.
  bool bends = true;
};

// The loop around a hole and those of islands in it, in any order, each running as find_holes() has
// them.
using Hole = std::vector<HoleLoop>;

// The new faces of one hole: triangles of vertex ids, of which those from the mesh's number of
// vertices on are its own, and follow on those of the hole before.
struct FilledHole {
  std::vector<Vec3> points;     // of its own vertices
  std::vector<double> lengths;  // of edges wanted at each
  std::vector<Triangle> triangles;
};

// Why a hole is not filled, if so.
using Refusals = std::vector<std::optional<FairingError>>;

// Turns the loops as find_holes() has them, in whatever direction, order and from wherever they were
// given, and says of each hole why it is none of this mesh: repeated_vertex, nonmanifold_edge,
// inconsistent_orientation, too_large, bad_option. Throws FairingError for loops of fewer than three
// vertices (bad_option) and for ids of no vertex (index_out_of_range).
Refusals check_holes(const PolygonMesh& mesh, const HalfEdges& half_edges,
                     std::vector<Hole>& holes);

// Fills checked holes, one after another, but for those that are refused, before or here: where only
// faces without area would do, islands cannot be joined to the rim, or it would be too_large. One
// for each that is not.
std::vector<FilledHole> fill(const PolygonMesh& mesh, const HalfEdges& half_edges,
                             std::span<const Hole> holes, const FillOptions& options,
                             Refusals& refusals);

// The same fillings, of which the vertices of those `chosen` (one flag for each hole) have been moved:
// these get triangles that fit their new shape, which goes on between its vertices as a smooth surface
// where it is `fair` (flags, too). All vertices are numbered anew.
void refine_again(const PolygonMesh& mesh, const HalfEdges& half_edges, std::span<const Hole> holes,
                  const FillOptions& options, std::span<const std::uint8_t> chosen,
                  std::span<const std::uint8_t> fair, std::vector<FilledHole>& filled);

}  // namespace fairing
