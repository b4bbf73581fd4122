// SPDX-License-Identifier: GPL-3.0-or-later
// The topology of a refined surface: its control edges, the sectors of its vertices between
// creases, the curves along its edges, and the patches with their sides. A patch covers a grid of
// control quads (splines/layout.h). A control triangle is three patches, which meet at its centroid
// and at the midpoints of its edges.
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

  bool operator==(const HalfEdge&) const = default;
};

struct SideUse : HalfEdge {
  bool reversed;  // the side has the opposite direction of the edge
};

struct ControlEdge {
  EdgeKind kind = EdgeKind::boundary;
  bool halved = false;  // next to a triangle: its patches end at the midpoint
  std::vector<SideUse> uses;
  std::array<Index, 2> sectors{-1, -1};  // of its first use, at both ends

  // Whether it has two faces with the same orientation.
  bool plain() const { return uses.size() == 2 && uses[0].reversed != uses[1].reversed; }
};

// Control edges along one curve, straight through their vertices.
struct EdgeChain {
  EdgeKind kind = EdgeKind::smooth;
  std::vector<Index> edges;
  std::vector<std::uint8_t> reversed;  // whether each edge has the opposite direction of the curve
  std::vector<int> cuts;               // ends of patches, in half edges; includes both ends

  int halves() const { return 2 * int(edges.size()); }
  // Thin plates have poles of curvature at vertices, so all vertices are at knots. Cuts take
  // degrees of freedom.
  int least_spans() const;
  bool operator==(const EdgeChain&) const = default;
};

// The place of an edge in its chain; -1: inside a patch.
struct ChainPlace {
  Index chain = -1;
  int at = 0;
};

// On so many faces' sides in a row, or on a third's, with so many steps a span. The equations of a
// patch take time by the fourth power of its spans: one face has many, where it needs them, and
// `several` have few on each, in all as many as an edge has samples.
int most_spans_on(const Lattice& lattice, int faces, bool third = false, bool several = false,
                  int steps = steps_a_span);

// The part of a curve that is a side of a patch, in half edges of `all`. Curves are numbered:
// chains first, then three for each triangle, from the midpoint of side s to the centroid.
struct PatchSide {
  Index curve = -1;
  int from = 0, to = 2, all = 2;
  bool reversed = false;  // opposite to the side's direction, that of u or v
};

// Sides: v = 0, u = 1, v = 1, u = 0.
struct PatchPlace {
  FaceGrid grid;
  int corner = -1;  // of a triangle; -1: quads
  std::array<PatchSide, 4> side;

  bool several() const { return grid.faces.size() > 1; }
  // On so many of its faces in a row.
  int most_spans(const Lattice& lattice, int faces, int steps = steps_a_span) const {
    return most_spans_on(lattice, faces, corner >= 0, several(), steps);
  }
};

// Whether the creases that bound a sector of a vertex lie in one plane there, as on a smooth
// surface. Otherwise they leave it slightly, or so sharply that no patch can be judged at the
// vertex.
enum class Kink : std::uint8_t { none, slight, sharp };

struct Topology {
  std::vector<ControlEdge> edges;
  std::vector<std::array<Index, 4>> face_edges;    // by side
  std::vector<std::array<Index, 4>> face_sectors;  // by corner
  std::vector<std::vector<GridPoint>> sectors;     // corners: i is the face, j the corner
  std::vector<Kink> kinks;                         // by sectors (CurveSource::kinks())
  // splines/chains.h
  std::vector<EdgeChain> chains;
  std::vector<ChainPlace> places;  // by edges
  std::vector<PatchPlace> patches;

  const ControlEdge& edge(HalfEdge h) const { return edges[face_edges[h.face][h.side]]; }
  // The same edge from the other side; without a face unless there is exactly one.
  HalfEdge twin(HalfEdge h) const;
  bool runs_back(HalfEdge h) const;  // opposite to its edge
  // The chain of a side of a triangle; no patch goes on there.
  Index chain_of(HalfEdge h) const { return places[face_edges[h.face][h.side]].chain; }
  Index curves(const Lattice& lattice) const {
    return Index(chains.size()) + 3 * lattice.triangle_faces();
  }
};

// Whether a point of a control face is within a span's steps of the tip of a sharp kink. Cells next
// to it have an angle at every level, which says nothing of the smoothness elsewhere; nor do
// patches there.
bool in_tip(const Lattice& lattice, const Topology& topology, Index f, GridPoint p);

// Sets edges and sectors.
Topology make_topology(const Lattice& lattice);

}  // namespace fairing
