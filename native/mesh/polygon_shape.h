// SPDX-License-Identifier: GPL-3.0-or-later
// The shape of a polygon in its mean plane (Newell's: its normal is the vector of the polygon's
// projected areas), and how to cut it. Nothing here depends on which corner is first, bit for bit:
// two runs on one mesh, numbered differently, have the same faces and centres.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/types.h"
#include "mesh/polygon_mesh.h"

namespace fairing {

// Twice a face's vector area, from triangles about its first corner.
Vec3 twice_vector_area(const PolygonMesh& mesh, std::int64_t f);

class PolygonShape {
 public:
  // Three corners or more, counter-clockwise, with an area.
  explicit PolygonShape(std::span<const Vec3> corners);

  std::size_t size() const { return corners_.size(); }
  double area() const { return area_; }
  const Vec3& normal() const { return normal_; }

  // The area centroid, where a centre vertex is placed.
  Vec3 centroid() const { return origin_ + centre_of_area(); }

  // Every side is visible from the centroid, counter-clockwise and at some distance.
  bool star_shaped() const;

  // Some interior angle exceeds 170°.
  bool concave() const;

  // For a quad: it folds by more than 60° even along the flatter diagonal.
  bool warped() const;

  // How far the triangle of these corners is from equilateral: the sum of its squared sides over 4
  // √3 times its area in the mean plane. 1 for an equilateral one; infinite if the area is not
  // positive there.
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

// Cuts along the diagonals of the triangulation of least total badness, by dynamic programming over
// the allowed diagonals (i, j). If several triangulations are equally good (to 1e-6), only their
// common diagonals are cut, and the piece between stays whole, so that the result depends neither
// on the first corner nor on mirroring. Without a triangulation the result is the whole polygon.
// Cubic in the number of corners.
std::vector<Piece> cut_polygon(const PolygonShape& shape,
                               const std::function<bool(std::size_t, std::size_t)>& allowed);

}  // namespace fairing
