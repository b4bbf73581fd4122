// SPDX-License-Identifier: GPL-3.0-or-later
// A refined surface in the form of the output: the cells of every control face, row by row
// (fairing/output.h). Numbers of points are computed; control faces are numbered triangles first.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
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

// A span has at least this number of steps of the lattice, and samples; more than most_spans in a
// direction cost more than they gain.
constexpr int steps_a_span = 4, most_spans = 16;

class Lattice {
 public:
  // Throws FairingError(bad_shape) if the arrays are not complete control faces or have indices out
  // of range.
  explicit Lattice(const RefinedSurface& surface);

  int n() const { return n_; }
  std::size_t points() const { return surface_.vertices.size() / 3; }
  Index faces() const { return triangle_faces_ + quad_faces_; }
  Index triangle_faces() const { return triangle_faces_; }
  bool quad(Index f) const { return f >= triangle_faces_; }
  int corners(Index f) const { return quad(f) ? 4 : 3; }

  // Closed coordinates (grid/grid_level.h).
  Index point(Index f, GridPoint p) const;
  // Point k along side s, r rows inside the face.
  Index point(Index f, int s, int k, int r) const {
    return point(f, closed_point(quad(f), n_, s, k, r));
  }
  Vec3 position(Index p) const {
    const double* at = &surface_.vertices[3 * std::size_t(p)];
    return {at[0], at[1], at[2]};
  }
  Vec3 position(Index f, GridPoint p) const { return position(point(f, p)); }

  const RefinedSurface& surface() const { return surface_; }
  // The largest extent of the points along a coordinate axis.
  double size() const { return size_; }

 private:
  RefinedSurface surface_;
  int n_;
  Index triangle_faces_, quad_faces_;
  double size_ = 0;
};

// A control face, with the side that is the first one of its grid.
struct PlacedFace {
  Index face;
  int turn;

  bool operator==(const PlacedFace&) const = default;
};

// Adjacent control quads, row by row; or one triangle.
struct FaceGrid {
  int columns = 1, rows = 1;
  std::vector<PlacedFace> faces;

  bool operator==(const FaceGrid&) const = default;
};

// The points of a grid of faces, numbered as one face: (0, 0) … (columns n, rows n).
class Sheet {
 public:
  Sheet(const Lattice& lattice, Index f) : lattice_(lattice), one_{f, 0} {}
  // Keeps a reference to the grid.
  Sheet(const Lattice& lattice, const FaceGrid& grid)
      : lattice_(lattice), many_(grid.faces), columns_(grid.columns), rows_(grid.rows) {}

  const Lattice& lattice() const { return lattice_; }
  bool quads() const {
    return !many_.empty() ? lattice_.quad(many_[0].face) : lattice_.quad(one_.face);
  }
  int width() const { return columns_ * lattice_.n(); }
  int height() const { return rows_ * lattice_.n(); }
  bool inside(GridPoint p) const {
    return p.i >= 0 && p.j >= 0 &&
           (quads() ? p.i <= width() && p.j <= height() : p.i + p.j <= width());
  }
  // The face of the grid that contains a point.
  int place(GridPoint p) const {
    const int n = lattice_.n();
    return std::min(p.j / n, rows_ - 1) * columns_ + std::min(p.i / n, columns_ - 1);
  }
  struct Spot {
    Index face;
    GridPoint at;
  };
  Spot spot(GridPoint p) const;
  Vec3 position(GridPoint p) const {
    const Spot found = spot(p);
    return lattice_.position(found.face, found.at);
  }

 private:
  const Lattice& lattice_;
  PlacedFace one_{};
  std::span<const PlacedFace> many_;
  int columns_ = 1, rows_ = 1;
};

// The tangent at an end of a side of the lattice, away from it: that of the cubic through the first
// points.
Vec3 end_tangent(const Lattice& lattice, Index f, int s, bool at_end);

// Two unit vectors that form a right-handed frame with n.
Eigen::Matrix<double, 3, 2> tangents_of(const Vec3& n);

// Components of `rest` along two directions, by least squares; zero if these are parallel.
struct Slide {
  double along_u, along_v;
};
Slide slide_to(const Vec3& rest, const Vec3& u, const Vec3& v);

// The points near one point of the lattice, face by face.
struct NearbyPoints {
  Vec3 centre = Vec3::Zero();
  std::vector<Vec3> points;
  std::vector<std::size_t> ends;  // of each face's points

  void end_face() { ends.push_back(points.size()); }
  // Of the last face.
  std::span<const Vec3> last_face() const;
};

// Where curvature may jump: nowhere; across an edge; between all faces.
struct CurvatureJump {
  bool jumps = false;
  Vec3 edge = Vec3::Zero();  // its direction, a unit vector; zero: between all
};

// The normal at the centre of the surface through the other points: that of a height function over
// the plane of `guess`, up to cubic if there are enough points; refitted once. Beyond an edge across
// which curvature jumps there are terms of its own; with jumps between all faces each has its own
// quadratic and cubic terms.
Vec3 fitted_normal(const NearbyPoints& nearby, const Vec3& guess, const CurvatureJump& jump = {});

// The area-weighted normal at a point of the lattice, from its neighbours.
Vec3 area_normal(const Sheet& sheet, GridPoint p);
Vec3 lattice_normal(const Lattice& lattice, Index f, GridPoint p);

}  // namespace fairing
