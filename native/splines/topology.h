// SPDX-License-Identifier: GPL-3.0-or-later
// What is next to what: the control edges of a refined surface, the sectors of its vertices between
// creases, and the patches with their sides. A control quad is one patch. A control triangle is
// three: they meet at its centroid and in the middles of its edges.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "splines/lattice.h"

namespace fairing {

enum class EdgeKind : std::uint8_t { smooth, crease, boundary };

struct SideUse {
  Index face;
  int side;
  bool reversed;  // the side runs from the edge's second end to its first
};

struct ControlEdge {
  EdgeKind kind = EdgeKind::boundary;
  bool halved = false;  // beside a triangle: its patches end in the middle
  std::vector<SideUse> uses;
  std::array<Index, 2> sectors{-1, -1};  // of its first use, at both ends
};

// Which part of a curve a patch's side is.
enum class Part : std::uint8_t { whole, first_half, second_half };

// Curves are numbered: control edges first, then three a triangle, that of side s from the side's
// middle to the centroid.
struct PatchSide {
  Index curve;
  Part part;
  bool reversed;  // against the side's own direction, that of growing u or v
};

// Sides: v = 0, u = 1, v = 1, u = 0.
struct PatchPlace {
  Index face;
  int corner;  // of a triangle; -1: a whole quad
  std::array<PatchSide, 4> side;
};

// Whether the creases that bound a sector of a vertex lie in one plane there, as in a surface that
// is smooth; out of it they bend slightly, or so sharply that no patch can be judged at the vertex.
enum class Kink : std::uint8_t { none, slight, sharp };

struct Topology {
  std::vector<ControlEdge> edges;
  std::vector<std::array<Index, 4>> face_edges;    // by side
  std::vector<std::array<Index, 4>> face_sectors;  // by corner
  std::vector<std::vector<GridPoint>> sectors;     // corners: i the face, j the corner
  std::vector<PatchPlace> patches;
  std::vector<Kink> kinks;  // by sectors (CurveSource::kinks())

  Index curves(const Lattice& lattice) const {
    return Index(edges.size()) + 3 * lattice.triangle_faces();
  }
};

// Whether a point of a control face is in the tip of a sharp kink, within a span's steps. Cells next to
// it turn at every level: they say nothing of a surface that is smooth elsewhere, nor do patches there.
bool in_tip(const Lattice& lattice, const Topology& topology, Index f, GridPoint p);

Topology make_topology(const Lattice& lattice);

}  // namespace fairing
