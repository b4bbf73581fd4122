// SPDX-License-Identifier: GPL-3.0-or-later
// Few and large patches: control quads in grids that are as large as creases, borders and
// extraordinary vertices allow.
#pragma once

#include <span>

#include "splines/topology.h"

namespace fairing {

// What a grid may not cross, and where lines of edges end.
struct Walls {
  std::vector<std::array<Index, 4>> vertices;  // of faces, by corner; numbered from 0
  std::vector<std::uint8_t> edge;              // creases, borders, and between groups
  // Of vertices: lines run straight through it, as around four quads, or along a border of two.
  std::vector<std::uint8_t> regular;

  Index start(HalfEdge h) const { return vertices[std::size_t(h.face)][std::size_t(h.side)]; }
};

// `groups`: of faces, empty or a number each; a grid has faces of one. Lines that turn by more than
// `straight`, radians, are not smooth.
Walls find_walls(const Lattice& lattice, const Topology& topology,
                 std::span<const std::int32_t> groups, double straight);

// Lines from each vertex that is not regular run on until they meet one another (Eppstein et al.
// 2008); of the grids between them two become one wherever they share a whole side.
std::vector<FaceGrid> lay_out(const Lattice& lattice, const Topology& topology, const Walls& walls);

// The side of a face at place q along side s of a grid, counter-clockwise.
HalfEdge half_edge(const FaceGrid& grid, int s, int q);
inline int length(const FaceGrid& grid, int s) { return s % 2 ? grid.rows : grid.columns; }
// The same grid, whose side s is the first.
FaceGrid turned(const FaceGrid& grid, int s);

// Straight on through a vertex of two quads or four: past the end of a side, or before its start.
HalfEdge straight_on(const Topology& topology, HalfEdge h);
HalfEdge straight_back(const Topology& topology, HalfEdge h);

}  // namespace fairing
