// SPDX-License-Identifier: GPL-3.0-or-later
// Lays out few, large patches: control quads in grids as large as creases, borders and
// extraordinary vertices allow.
#pragma once

#include <span>

#include "splines/topology.h"

namespace fairing {

// The edges that a grid may not cross, and the vertices where lines of edges end.
struct Walls {
  std::vector<std::array<Index, 4>> vertices;  // of faces, by corner; numbered from 0
  std::vector<std::uint8_t> edge;              // 1 for creases, borders, and edges between groups
  // Whether lines continue straight through a vertex: one of four quads, or of two at a border.
  std::vector<std::uint8_t> regular;

  Index start(HalfEdge h) const { return vertices[h.face][h.side]; }
};

// `groups`: a number for each face, or empty; all faces of a grid have the same one. Lines that
// turn by more than `straight`, radians, are not smooth.
Walls find_walls(const Lattice& lattice, const Topology& topology,
                 std::span<const std::int32_t> groups, double straight);

// Lines from all vertices that are not regular continue until they meet one another (Eppstein et
// al. 2008); two grids between them are merged if they share a whole side.
std::vector<FaceGrid> lay_out(const Lattice& lattice, const Topology& topology, const Walls& walls);

// The side of a face at place q of side s of a grid, counter-clockwise.
HalfEdge half_edge(const FaceGrid& grid, int s, int q);
inline int length(const FaceGrid& grid, int s) { return s % 2 ? grid.rows : grid.columns; }
// The same grid with side s as the first one.
FaceGrid turned(const FaceGrid& grid, int s);

// The continuation of a side straight through a vertex of two or four quads: beyond its end, or
// before its start.
HalfEdge straight_on(const Topology& topology, HalfEdge h);
HalfEdge straight_back(const Topology& topology, HalfEdge h);

}  // namespace fairing
