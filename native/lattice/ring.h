// SPDX-License-Identifier: GPL-3.0-or-later
// The one-rings of control vertices and edge points, in the order of their charts.
#pragma once

#include <span>
#include <vector>

#include "lattice/closed_face.h"

namespace fairing {

// Calls visit(point, slot) for the ring of control vertex v; `slot` is the place of that neighbour among the two
// points a spoke that accumulate() hands to its vertex body.
template <class Visit>
void visit_ring(const Lattice& lattice, Index v, Visit&& visit) {
  std::size_t slot = 0;
  for (const Spoke& spoke : lattice.mesh().ring(v)) {
    visit(lattice.spoke_point(spoke), slot);
    if (spoke.face >= 0 && lattice.mesh().faces[std::size_t(spoke.face)].quad())
      visit(lattice.diagonal_point(spoke), slot + 1);
    slot += 2;
  }
}

// The lattice steps to the neighbours of a point inside a face.
inline std::span<const LatticePoint> face_ring(bool quad) {
  static constexpr LatticePoint triangle_ring[] = {{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}};
  static constexpr LatticePoint quad_ring[] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                               {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
  if (quad) return quad_ring;
  return triangle_ring;
}

// Where the neighbours of an edge's points are: neighbour j of point k is in lane[j] at place k + at[j], with lanes
// 0: the edge itself, 1: the left face's first row, 2: the right face's. All lanes run with the edge.
struct EdgeRingLanes {
  int size = 0;
  int lane[8], at[8];
  bool far[8];  // the corner across a quad

  EdgeRingLanes(const ControlMesh& mesh, Index e) {
    const Edge& edge = mesh.edges[std::size_t(e)];
    for (int h = 0; h < 2; ++h) {
      const int ahead = h == 0 ? 1 : -1;
      push(0, ahead, false);
      if (edge.side[std::size_t(h)] < 0) continue;
      const Side& side = mesh.sides[std::size_t(edge.side[std::size_t(h)])];
      const bool quad = mesh.faces[std::size_t(side.face)].quad();
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

// The points of the ring of an edge's point k, or of the point (i, j) inside a face, appended to `ids`.
inline void append_ring(const Lattice& lattice, Index e, const EdgeRingLanes& ring, int k,
                        std::vector<Index>& ids) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  for (int j = 0; j < ring.size; ++j) {
    const int lane = ring.lane[j], at = ring.at[j] + k;
    if (lane == 0) {
      ids.push_back(lattice.edge_point(e, at));
      continue;
    }
    const Side& side = mesh.sides[std::size_t(mesh.edges[std::size_t(e)].side[std::size_t(lane - 1)])];
    const bool quad = mesh.faces[std::size_t(side.face)].quad();
    const int along = side.reversed ? row_size(quad, n) - 1 - at : at;
    ids.push_back(lattice.face_point(side.face, closed_point(quad, n, side.local, along, 1)));
  }
}
inline void append_ring(const Lattice& lattice, Index f, LatticePoint p, std::vector<Index>& ids) {
  for (const LatticePoint d : face_ring(lattice.mesh().faces[std::size_t(f)].quad()))
    ids.push_back(lattice.face_point(f, p.i + d.i, p.j + d.j));
}

// The edge and the rows beside it, gathered into scratch; all run with the edge. Each lane has room for a
// block more.
template <class T, int C = 3>
struct EdgeLanes {
  T* lane[3] = {};

  EdgeLanes() = default;
  EdgeLanes(const Lattice& lattice, const T* x, Index e, std::vector<T>& scratch) {
    const ControlMesh& mesh = lattice.mesh();
    const std::size_t stride = lane_stride<C>(lattice.n()) + lane_block;
    if (scratch.size() < 3 * stride) scratch.resize(3 * stride);
    for (std::size_t l = 0; l < 3; ++l) lane[l] = scratch.data() + l * stride;
    gather_edge<C>(lattice, x, e, lane[0]);
    for (std::size_t h = 0; h < 2; ++h) {
      const Index side = mesh.edges[std::size_t(e)].side[h];
      if (side >= 0) gather_row<C>(lattice, x, mesh.sides[std::size_t(side)], lane[1 + h]);
    }
  }
};

}  // namespace fairing
