// SPDX-License-Identifier: GPL-3.0-or-later
// A refined surface as its output has it: the cells of every control face, row by row (fairing/
// output.h). Points are found by arithmetic; control faces are numbered triangles first.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "base/types.h"
#include "grid/grid_level.h"

namespace fairing {

struct RefinedSurface {
  int levels = 0;
  std::span<const double> vertices;                // 3 a point
  std::span<const std::int32_t> triangles, quads;  // 3 and 4 a cell, 4^levels cells a control face
  std::span<const std::int32_t> crease_edges;      // 2 control vertices an edge
};

// A span has at least so many steps of the lattice, and samples; more spans than that each way cost more
// than they gain.
constexpr int steps_a_span = 4, most_spans = 16;

class Lattice {
 public:
  // Throws FairingError(bad_shape) for arrays that are no whole control faces or name no vertices.
  explicit Lattice(const RefinedSurface& surface);

  int n() const { return n_; }
  std::size_t points() const { return surface_.vertices.size() / 3; }
  Index faces() const { return triangle_faces_ + quad_faces_; }
  Index triangle_faces() const { return triangle_faces_; }
  bool quad(Index f) const { return f >= triangle_faces_; }
  int corners(Index f) const { return quad(f) ? 4 : 3; }

  // Closed coordinates (grid/grid_level.h).
  Index point(Index f, GridPoint p) const;
  // k along side s, r rows into the face.
  Index point(Index f, int s, int k, int r) const {
    return point(f, closed_point(quad(f), n_, s, k, r));
  }
  Vec3 position(Index p) const {
    const double* at = &surface_.vertices[3 * std::size_t(p)];
    return {at[0], at[1], at[2]};
  }
  Vec3 position(Index f, GridPoint p) const { return position(point(f, p)); }

  const RefinedSurface& surface() const { return surface_; }
  // The largest extent of the points along an axis.
  double size() const { return size_; }

 private:
  RefinedSurface surface_;
  int n_;
  Index triangle_faces_, quad_faces_;
  double size_ = 0;
};

// Two unit vectors that make a right-handed frame with n.
Eigen::Matrix<double, 3, 2> tangents_of(const Vec3& n);

// How far along both directions `rest` reaches, by least squares; not at all along parallel ones.
struct Slide {
  double along_u, along_v;
};
Slide slide_to(const Vec3& rest, const Vec3& u, const Vec3& v);

// The normal at `centre` of the surface through these points nearby: that of a height function,
// cubic as far as their number allows, over the plane of `guess`. Refitted once.
Vec3 fitted_normal(const Vec3& centre, const std::vector<Vec3>& nearby, const Vec3& guess);

// The normal at a point of the lattice, from its neighbours; as long as the surface there is large.
Vec3 area_normal(const Lattice& lattice, Index f, GridPoint p);
Vec3 lattice_normal(const Lattice& lattice, Index f, GridPoint p);

}  // namespace fairing
