// SPDX-License-Identifier: GPL-3.0-or-later
// What is decided once for a whole mesh before it is faired in pieces: mending, orientation, the
// split of polygons, which edges are curves and their points, and the numbering of the result.
// Apart from the points of curves nothing here is larger than the control mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fairing/options.h"
#include "fairing/report.h"
#include "mesh/mend/mend.h"
#include "parallel/monitor.h"

namespace fairing {

// Kinds of a control edge, as bits.
enum EdgeKind : std::uint8_t {
  plain_edge = 0,
  curve_edge = 1,     // a crease, or a boundary that is not free
  boundary_edge = 2,  // with one face
  split_edge = 4,     // inside a polygon of the input
  straight_edge = 8,  // of a boundary that is not smoothed
};

// Ids are those of the result: sheets are joined, and points are in the order of grid/grid_level.h.
struct Outline {
  // The mesh to fair, 3 numbers a vertex: mended, with consistent orientation.
  OwnedPolygonMesh mesh{};
  std::optional<MendedMesh> mended{};  // if `mesh` is not the given one
  FairOptions options{};               // in the ids of `mesh`

  // Centres of split polygons, 3 numbers each, which follow the vertices: those of the mesh, then
  // of each shape.
  std::vector<double> centres{};
  std::vector<std::int32_t> face{};  // 4 vertices per control face; -1 as the fourth of a triangle
  std::vector<std::int32_t> polygon{};    // per control face: the face of `mesh` that it is part of
  std::vector<std::int32_t> side_edge{};  // 4 per control face
  std::vector<std::uint8_t> side_reversed{};
  std::vector<std::int32_t> edge{};       // 2 vertices per edge
  std::vector<std::uint8_t> edge_kind{};  // EdgeKind
  std::vector<std::int32_t> curve{};      // the edges that have refined curves, ascending
  // Points inside these edges, from the edge's first vertex on, world: those of the mesh, then of
  // each shape.
  std::vector<double> curve_points{};
  std::vector<double> shapes{};  // other positions of the mesh's vertices, shape after shape
  MeshUnits units{};             // in world coordinates
  Report report{};               // warnings, repairs, turned faces, sheets
};

// Throws the errors of fair() for the mesh and the options.
Outline outline_of(const PolygonMesh& input, const FairOptions& options, Monitor& monitor);

}  // namespace fairing
