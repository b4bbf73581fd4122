// SPDX-License-Identifier: GPL-3.0-or-later
#include "control_mesh/polygon_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace fairing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double tan_10_degrees = 0.17632698070846498;
constexpr double cos_60_degrees = 0.5;
constexpr double least_distance =
    0.01;  // of a star's sides from its centre, relative to the root of its area
constexpr double least_flatness = 1e-9;  // a triangle's projected area over its sides' squares

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

PolygonShape::PolygonShape(std::span<const Vector3d> corners) {
  const std::size_t n = corners.size();
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : corners) mean += (p - corners[0]) / double(n);
  mean += corners[0];
  for (const Vector3d& p : corners) corners_.push_back(p - mean);

  Vector3d area = Vector3d::Zero();
  for (std::size_t i = 0; i < n; ++i) area += 0.5 * corners_[i].cross(corners_[(i + 1) % n]);
  area_ = area.norm();
  normal_ = area / area_;

  Vector3d moment = Vector3d::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d &a = corners_[i], &b = corners_[(i + 1) % n];
    moment += 0.5 * normal_.dot(a.cross(b)) * (a + b) / 3;
  }
  centroid_ = mean + moment / area_;

  const Vector3d u = normal_.unitOrthogonal(), v = normal_.cross(u);
  for (const Vector3d& p : corners_) plane_.emplace_back(u.dot(p), v.dot(p));
  centre_ = Vector2d(u.dot(moment), v.dot(moment)) / area_;
}

bool PolygonShape::star_shaped() const {
  for (std::size_t i = 0; i < size(); ++i) {
    const Vector2d a = plane_[i] - centre_, b = plane_[(i + 1) % size()] - centre_;
    if (!(cross(a, b) > least_distance * std::sqrt(area_) * (b - a).norm())) return false;
  }
  return true;
}

bool PolygonShape::concave() const {
  for (std::size_t i = 0; i < size(); ++i) {
    const Vector2d in = plane_[i] - plane_[(i + size() - 1) % size()];
    const Vector2d out = plane_[(i + 1) % size()] - plane_[i];
    const double turn = cross(in, out), ahead = in.dot(out);
    if (!(turn > 0) || turn < tan_10_degrees * ahead) return true;
  }
  return false;
}

Vector3d PolygonShape::corner_area(std::size_t i) const {
  const std::size_t n = size();
  return (corners_[i] - corners_[(i + n - 1) % n]).cross(corners_[(i + 1) % n] - corners_[i]);
}

bool PolygonShape::warped() const {
  const auto cosine = [](const Vector3d& a, const Vector3d& b) { return a.dot(b) / (a.norm() * b.norm()); };
  const double along_02 = cosine(corner_area(1), corner_area(3));
  const double along_13 = cosine(corner_area(0), corner_area(2));
  return !(std::max(along_02, along_13) >= cos_60_degrees);
}

double PolygonShape::badness(std::size_t i, std::size_t j, std::size_t k) const {
  const double squares = (corners_[i] - corners_[j]).squaredNorm() +
                         (corners_[j] - corners_[k]).squaredNorm() +
                         (corners_[k] - corners_[i]).squaredNorm();
  const double twice_area = cross(plane_[j] - plane_[i], plane_[k] - plane_[i]);
  if (!(twice_area > least_flatness * squares)) return std::numeric_limits<double>::infinity();
  return squares / (2 * std::sqrt(3.0) * twice_area);
}

}  // namespace fairing
