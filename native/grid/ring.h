// SPDX-License-Identifier: GPL-3.0-or-later
// The one-rings of control vertices and edge points, in the order of their charts.
#pragma once

#include <span>
#include <vector>

#include "grid/gather.h"

namespace fairing {

// Calls visit(point, slot) for the ring of control vertex v. Slots are those of accumulate()'s
// vertex body, two per spoke: 2 s is the point along spoke s, 2 s + 1 the one across its quad, if
// any.
template <class Visit>
void visit_ring(const GridLevel& grid, Index v, Visit&& visit) {
  std::size_t slot = 0;
  for (const Spoke& spoke : grid.mesh().ring(v)) {
    visit(grid.spoke_point(spoke), slot);
    if (spoke.face >= 0 && grid.mesh().faces[spoke.face].quad())
      visit(grid.diagonal_point(spoke), slot + 1);
    slot += 2;
  }
}

// The grid steps to the neighbours of a point inside a face, counter-clockwise: first along the
// grid's directions, then back along them.
inline constexpr GridPoint triangle_ring[] = {{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}};
inline constexpr GridPoint quad_ring[] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                          {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
constexpr std::span<const GridPoint> face_ring(bool quad) {
  if (quad) return quad_ring;
  return triangle_ring;
}

// The grid's directions inside a face: three in a triangle; four in a quad, of which every other
// one crosses its cells.
constexpr std::span<const GridPoint> face_directions(bool quad) {
  return face_ring(quad).first(quad ? 4 : 3);
}

// The neighbours of an edge's points: neighbour j of point k is element k + at[j] of lane[j]. Lane
// 0 is the edge itself, lanes 1 and 2 are the first rows of the left and the right face; all run
// with the edge. The lane of a missing face is not referenced.
struct EdgeRingLanes {
  int size = 0;
  int lane[8], at[8];
  bool far[8];  // the corner across a quad

  EdgeRingLanes(const ControlMesh& mesh, Index e) {
    const Edge& edge = mesh.edges[e];
    for (int h = 0; h < 2; ++h) {
      const int ahead = h == 0 ? 1 : -1;
      push(0, ahead, false);
      if (edge.side[h] < 0) continue;
      const Side& side = mesh.sides[edge.side[h]];
      const bool quad = mesh.faces[side.face].quad();
      if (quad) {
        push(1 + h, ahead, true);
        push(1 + h, 0, false);
        push(1 + h, -ahead, true);
      } else {
        push(1 + h, h == 0 ? 0 : -1, false);
        push(1 + h, h == 0 ? -1 : 0, false);
      }
    }
  }

 private:
  void push(int l, int a, bool f) {
    far[size] = f;
    lane[size] = l;
    at[size] = a;
    ++size;
  }
};

// Appends to `ids` the ring of an edge's point k, or of the point (i, j) inside a face.
inline void append_ring(const GridLevel& grid, Index e, const EdgeRingLanes& ring, int k,
                        std::vector<Index>& ids) {
  const ControlMesh& mesh = grid.mesh();
  const int n = grid.n();
  for (int j = 0; j < ring.size; ++j) {
    const int lane = ring.lane[j], at = ring.at[j] + k;
    if (lane == 0) {
      ids.push_back(grid.edge_point(e, at));
      continue;
    }
    const Side& side = mesh.sides[mesh.edges[e].side[lane - 1]];
    const bool quad = mesh.faces[side.face].quad();
    const int along = side.reversed ? row_size(quad, n) - 1 - at : at;
    ids.push_back(grid.face_point(side.face, closed_point(quad, n, side.local, along, 1)));
  }
}
inline void append_ring(const GridLevel& grid, Index f, GridPoint p, std::vector<Index>& ids) {
  for (const GridPoint d : face_ring(grid.mesh().faces[f].quad()))
    ids.push_back(grid.face_point(f, p.i + d.i, p.j + d.j));
}

// The lanes of EdgeRingLanes with the values of x, gathered into `scratch`. Each lane has
// lane_block extra numbers.
template <class T, int C = 3>
struct EdgeLanes {
  T* lane[3] = {};

  EdgeLanes() = default;
  EdgeLanes(const GridLevel& grid, const T* x, Index e, std::vector<T>& scratch) {
    const ControlMesh& mesh = grid.mesh();
    const std::size_t stride = lane_stride<C>(grid.n()) + lane_block;
    if (scratch.size() < 3 * stride) scratch.resize(3 * stride);
    for (std::size_t l = 0; l < 3; ++l) lane[l] = scratch.data() + l * stride;
    gather_edge<C>(grid, x, e, lane[0]);
    for (std::size_t h = 0; h < 2; ++h) {
      const Index side = mesh.edges[e].side[h];
      if (side >= 0) gather_row<C>(grid, x, mesh.sides[side], lane[1 + h]);
    }
  }
};

}  // namespace fairing
