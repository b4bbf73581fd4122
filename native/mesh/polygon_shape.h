// SPDX-License-Identifier: GPL-3.0-or-later
// What a polygon in space looks like in its mean plane (Newell's: its normal is the vector of the
// polygon's projected areas), and how to cut it. Nothing here depends on which corner is first, not
// even in the last bit: two runs on one mesh, numbered differently, have the same faces and centres.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/types.h"
#include "mesh/polygon_mesh.h"

namespace fairing {

// A face's vector of projected areas, twice as long: as triangles about its first corner have it.
Vec3 twice_vector_area(const PolygonMesh& mesh, std::int64_t f);

class PolygonShape {
 public:
  // Three corners or more, counter-clockwise, with an area.
  explicit PolygonShape(std::span<const Vec3> corners);

  std::size_t size() const { return corners_.size(); }
  double area() const { return area_; }
  const Vec3& normal() const { return normal_; }

  // The centroid of the area: where a centre vertex would go.
  Vec3 centroid() const { return origin_ + centre_of_area(); }

  // Every side is seen from the centroid at a fair distance, and counter-clockwise.
  bool star_shaped() const;

  // Some interior angle is wider than 170°.
  bool concave() const;

  // For a quad: even along the flatter diagonal it folds by more than 60°.
  bool warped() const;

  // How far the triangle of these corners is from equilateral: the sum of its squared sides over 4
  // √3 times its area in the mean plane; 1 at best, infinite where the area is not positive there.
  // Small where it is well shaped and flat; finite only inside the polygon.
  double badness(std::size_t i, std::size_t j, std::size_t k) const;

 private:
  Vec3 vector_area() const;
  Vec3 centre_of_area() const;  // relative to the mean
  Vec2 project(const Vec3& p) const { return {along_.dot(p), across_.dot(p)}; }
  Vec3 corner_area(std::size_t i) const;

  Vec3 origin_;                // their mean
  std::vector<Vec3> corners_;  // relative to their mean
  std::vector<Vec2> plane_;    // the same, projected
  Vec3 normal_, along_, across_;
  double area_ = 0;
};

// The corners of one piece, ascending.
using Piece = std::vector<std::size_t>;

// Cuts along the diagonals of the triangulation of least total badness, found by dynamic
// programming over the allowed diagonals (i, j). Where several triangulations are equally good (to
// 1e-6), only the diagonals that all of them share are cut, and the piece between stays whole: to
// prefer one by order would break the polygon's symmetry. So the result depends neither on the
// first corner nor on mirroring; without any triangulation it is the whole polygon. Cubic in the
// number of corners.
std::vector<Piece> cut_polygon(const PolygonShape& shape,
                               const std::function<bool(std::size_t, std::size_t)>& allowed);

}  // namespace fairing
