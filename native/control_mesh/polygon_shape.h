// SPDX-License-Identifier: GPL-3.0-or-later
// What a polygon in space looks like in its mean (Newell) plane. Nothing here depends on which corner is
// first.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace fairing {

class PolygonShape {
 public:
  // Three corners or more, counter-clockwise, with an area.
  explicit PolygonShape(std::span<const Eigen::Vector3d> corners);

  std::size_t size() const { return corners_.size(); }
  double area() const { return area_; }
  const Eigen::Vector3d& normal() const { return normal_; }

  // The centroid of the area: where a centre vertex would go.
  const Eigen::Vector3d& centroid() const { return centroid_; }

  // Every side is seen from the centroid at a fair distance, and counter-clockwise.
  bool star_shaped() const;

  // Some interior angle is wider than 170°.
  bool concave() const;

  // For a quad: even along the flatter diagonal it folds by more than 60°.
  bool warped() const;

  // How far the triangle is from equilateral: 1 at best; infinite where it lies upside down or has no area in
  // the plane. Prefers what is short, well shaped and flat, and only what is inside.
  double badness(std::size_t i, std::size_t j, std::size_t k) const;

 private:
  Eigen::Vector3d corner_area(std::size_t i) const;

  std::vector<Eigen::Vector3d> corners_;  // relative to their mean
  std::vector<Eigen::Vector2d> plane_;    // the same, projected
  Eigen::Vector3d normal_, centroid_;
  Eigen::Vector2d centre_;  // the centroid, projected
  double area_ = 0;
};

}  // namespace fairing
