// SPDX-License-Identifier: GPL-3.0-or-later
// All that is decided once for a whole mesh before it is faired in pieces: what is mended, which way
// faces run, how polygons split, which edges are curves and where these lie, and how the points of
// the result are numbered. Nothing here is larger than the control mesh but the points of curves.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fairing/options.h"
#include "fairing/report.h"
#include "mesh/mend/mend.h"
#include "parallel/monitor.h"

namespace fairing {

// What an edge of the control mesh is, as bits.
enum EdgeKind : std::uint8_t {
  plain_edge = 0,
  curve_edge = 1,     // a crease, or a boundary that is not free
  boundary_edge = 2,  // of one face
  split_edge = 4,     // inside a polygon of the input
  straight_edge = 8,  // of a boundary that is not smoothed
};

// Ids are those of the result: of its sheets, which are joined, and in the order of its points
// (grid/grid_level.h).
struct Outline {
  // The mesh as it is faired, 3 numbers a vertex: mended, its faces turned where they must be.
  OwnedPolygonMesh mesh{};
  std::optional<MendedMesh> mended{};  // where that is not the one given
  FairOptions options{};               // as of that mesh

  // Of split polygons, 3 numbers each, behind the vertices: those of the mesh, then of each shape.
  std::vector<double> centres{};
  std::vector<std::int32_t> face{};     // 4 vertices a control face; -1 behind those of a triangle
  std::vector<std::int32_t> polygon{};  // 1 a control face: the face of `mesh` that it is part of
  std::vector<std::int32_t> side_edge{};  // 4 a control face
  std::vector<std::uint8_t> side_reversed{};
  std::vector<std::int32_t> edge{};       // 2 vertices an edge
  std::vector<std::uint8_t> edge_kind{};  // EdgeKind
  std::vector<std::int32_t> curve{};      // the edges that have refined curves, ascending
  // Inside each of these, from its first vertex on; world: all those of the mesh, then of each shape.
  std::vector<double> curve_points{};
  std::vector<double> shapes{};  // other positions of the mesh's vertices, shape after shape
  MeshUnits units{};             // in world coordinates
  Report report{};               // warnings, repairs, turned faces, sheets
};

// Throws FairingError as fair() does for what is wrong with the mesh or the options.
Outline outline_of(const PolygonMesh& input, const FairOptions& options, Monitor& monitor);

}  // namespace fairing
