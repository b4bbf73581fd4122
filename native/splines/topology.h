// SPDX-License-Identifier: GPL-3.0-or-later
// What is next to what: the control edges of a refined surface, the sectors of its vertices between
// creases, the curves along its edges, and the patches with their sides. A patch covers a grid of
// control quads (splines/layout.h). A control triangle is three patches: they meet at its centroid
// and in the middles of its edges.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "splines/lattice.h"

namespace fairing {

enum class EdgeKind : std::uint8_t { smooth, crease, boundary };

// Side `side` of a face, counter-clockwise.
struct HalfEdge {
  Index face = -1;
  int side = 0;
};

struct SideUse : HalfEdge {
  bool reversed;  // the side runs from the edge's second end to its first
};

struct ControlEdge {
  EdgeKind kind = EdgeKind::boundary;
  bool halved = false;  // beside a triangle: its patches end in the middle
  std::vector<SideUse> uses;
  std::array<Index, 2> sectors{-1, -1};  // of its first use, at both ends

  // Two faces that look the same way.
  bool plain() const { return uses.size() == 2 && uses[0].reversed != uses[1].reversed; }
};

// Control edges that one curve follows, straight through their vertices.
struct EdgeChain {
  EdgeKind kind = EdgeKind::smooth;
  std::vector<Index> edges;
  std::vector<std::uint8_t> reversed;  // whether each edge runs against the curve
  std::vector<int> cuts;               // where patches end, in half edges; both ends included

  int halves() const { return 2 * int(edges.size()); }
  bool operator==(const EdgeChain&) const = default;
};

// Where an edge is in its chain; -1: inside a patch.
struct ChainPlace {
  Index chain = -1;
  int at = 0;
};

// The part of a curve that a patch's side is, in half edges of `all`. Curves are numbered: chains
// first, then three a triangle, that of side s from the side's middle to the centroid.
struct PatchSide {
  Index curve = -1;
  int from = 0, to = 2, all = 2;
  bool reversed = false;  // against the side's own direction, that of growing u or v
};

// Sides: v = 0, u = 1, v = 1, u = 0.
struct PatchPlace {
  FaceGrid grid;
  int corner = -1;  // of a triangle; -1: quads
  std::array<PatchSide, 4> side;

  bool several() const { return grid.faces.size() > 1; }
};

// Whether the creases that bound a sector of a vertex lie in one plane there, as in a surface that
// is smooth; out of it they bend slightly, or so sharply that no patch can be judged at the vertex.
enum class Kink : std::uint8_t { none, slight, sharp };

struct Topology {
  std::vector<ControlEdge> edges;
  std::vector<std::array<Index, 4>> face_edges;    // by side
  std::vector<std::array<Index, 4>> face_sectors;  // by corner
  std::vector<std::vector<GridPoint>> sectors;     // corners: i the face, j the corner
  std::vector<Kink> kinks;                         // by sectors (CurveSource::kinks())
  // splines/chains.h
  std::vector<EdgeChain> chains;
  std::vector<ChainPlace> places;  // by edges
  std::vector<PatchPlace> patches;

  const ControlEdge& edge(HalfEdge h) const {
    return edges[std::size_t(face_edges[std::size_t(h.face)][std::size_t(h.side)])];
  }
  // The same edge from the other side; no face where there is not just one.
  HalfEdge twin(HalfEdge h) const;
  bool runs_back(HalfEdge h) const;  // against its edge
  Index curves(const Lattice& lattice) const {
    return Index(chains.size()) + 3 * lattice.triangle_faces();
  }
};

// Whether a point of a control face is in the tip of a sharp kink, within a span's steps. Cells next to
// it turn at every level: they say nothing of a surface that is smooth elsewhere, nor do patches there.
bool in_tip(const Lattice& lattice, const Topology& topology, Index f, GridPoint p);

// Edges and sectors.
Topology make_topology(const Lattice& lattice);

}  // namespace fairing
