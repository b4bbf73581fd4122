// SPDX-License-Identifier: GPL-3.0-or-later
// The refined surface as grids over the control mesh. Level l splits every control edge into n =
// 2^l pieces; its points are numbered
//
//   [control vertices | edge interiors, edge by edge | face interiors, face by face, row by row]
//
// so that topology is arithmetic. (Hierarchical hybrid grids: Bergen & Hülsemann 2004.)
//
// *Closed coordinates* (i, j) of a face with corners c0 c1 c2 (c3): i runs along side 0, j along
// the last side reversed; a triangle holds i + j <= n, a quad i, j <= n. *Side coordinates* (k, r)
// of its side s: k along the side from corner s, r rows into the face.
#pragma once

#include <cstddef>

#include "mesh/control_mesh.h"

namespace fairing {

struct GridPoint {
  int i, j;
};

// Number of points inside a face of n subdivisions.
constexpr std::int64_t interior_size(bool quad, std::int64_t n) {
  return quad ? (n - 1) * (n - 1) : (n - 1) * (n - 2) / 2;
}

// Number of points of a closed face.
constexpr std::size_t closed_size(bool quad, std::size_t n) {
  return quad ? (n + 1) * (n + 1) : (n + 1) * (n + 2) / 2;
}

// Offset of (0, j) in a closed face stored row by row.
constexpr std::size_t closed_row(bool quad, std::size_t n, std::size_t j) {
  return quad ? j * (n + 1) : j * (n + 1) - (j * j - j) / 2;
}

// Offset of (1, j) among the interior points of a face, 1 <= j.
constexpr std::size_t interior_row(bool quad, std::size_t n, std::size_t j) {
  return quad ? (j - 1) * (n - 1) : (j - 1) * (n - 1) - (j - 1) * j / 2;
}

constexpr GridPoint closed_point(bool quad, int n, int side, int k, int r) {
  if (quad) {
    switch (side) {
      case 0: return {k, r};
      case 1: return {n - r, k};
      case 2: return {n - k, n - r};
      default: return {r, n - k};
    }
  }
  switch (side) {
    case 0: return {k, r};
    case 1: return {n - k - r, k};
    default: return {r, n - k - r};
  }
}

class GridLevel {
 public:
  GridLevel(const ControlMesh& mesh, int level);

  const ControlMesh& mesh() const { return *mesh_; }
  int level() const { return level_; }
  int n() const { return n_; }
  std::size_t size() const { return size_; }

  // Point k of an edge, 0 <= k <= n, counted from edge.vertex[0].
  Index edge_point(Index e, int k) const {
    const Edge& edge = mesh_->edges[e];
    if (k == 0) return edge.vertex[0];
    if (k == n_) return edge.vertex[1];
    return edge_base(e) + k - 1;
  }
  Index edge_base(Index e) const { return vertices_ + e * (n_ - 1); }

  Index face_base(Index f) const {
    const Index quads = quads_before_[f];
    return Index(first_face_ + std::int64_t(f - quads) * triangle_interior_ +
                 std::int64_t(quads) * quad_interior_);
  }

  // Point k of a side, counted from its first corner.
  Index side_point(const Side& side, int k) const {
    return edge_point(side.edge, side.reversed ? n_ - k : k);
  }

  // Any point of a closed face.
  Index face_point(Index f, int i, int j) const;
  Index face_point(Index f, GridPoint p) const { return face_point(f, p.i, p.j); }

  // The points next to control vertex v: along a spoke, and across the quad that follows it.
  Index spoke_point(const Spoke& spoke) const {
    return edge_point(spoke.edge, spoke.outward ? 1 : n_ - 1);
  }
  Index diagonal_point(const Spoke& spoke) const {
    return face_point(spoke.face, closed_point(true, n_, spoke.corner, 1, 1));
  }

 private:
  const ControlMesh* mesh_;
  int level_, n_;
  Index vertices_;
  std::int64_t first_face_, triangle_interior_, quad_interior_;
  std::size_t size_;
  std::vector<Index> quads_before_;  // per face
};

// Points of the given level of a mesh with these counts (no allocation).
std::int64_t grid_size(std::int64_t vertices, std::int64_t edges, std::int64_t triangles,
                       std::int64_t quads, int level);

}  // namespace fairing
