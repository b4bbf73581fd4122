// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/symmetry.h"

#include <Eigen/Geometry>
#include <cmath>

namespace fairing {
namespace {

std::vector<Vec3> points_with_faces(const ControlMesh& mesh) {
  std::vector<Vec3> points;
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    if (!mesh.ring(v).empty()) points.push_back(mesh.positions[v]);
  return points;
}

Vec3 mean_of(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / double(points.size());
}

template <class Distance>
const Vec3& farthest(const std::vector<Vec3>& points, Distance&& distance) {
  const Vec3* found = &points[0];
  double most = -1;
  for (const Vec3& p : points) {
    const double d = distance(p);
    if (d > most) {
      most = d;
      found = &p;
    }
  }
  return *found;
}

// Mirror planes contain the centroid, so they map every vertex to one at the same distance from it.
class Planes {
 public:
  Planes(const std::vector<Vec3>& points, double within)
      : points_(points), centre_(mean_of(points)), slack_(within) {}

  void add_coordinate_planes() {
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(centre_[axis]) <= slack_) found.push_back({Vec3::Unit(axis), 0.0});
  }

  template <class Alike>
  void add_bisectors(const Vec3& p, Alike&& alike) {
    for (const Vec3& w : points_) {
      const Vec3 between = p - w;
      if (between.norm() > slack_ && alike(w)) add(between);
    }
  }

  void add(const Vec3& normal) {
    if (!(normal.norm() > slack_)) return;
    const Vec3 n = normal.normalized();
    found.push_back({n, n.dot(centre_)});
  }

  const Vec3& centre() const { return centre_; }

  std::vector<Plane> found;

 private:
  const std::vector<Vec3>& points_;
  Vec3 centre_;
  double slack_;
};

}  // namespace

std::vector<Plane> mirror_planes(const ControlMesh& mesh, double tolerance) {
  const std::vector<Vec3> points = points_with_faces(mesh);
  if (points.empty()) return {};
  const double near = Plane::search_reach * tolerance;
  Planes planes(points, near);
  planes.add_coordinate_planes();

  const Vec3& c = planes.centre();
  const auto radius = [&](const Vec3& p) { return (p - c).norm(); };
  const Vec3 first = farthest(points, radius), along = first - c;
  const auto like_first = [&](const Vec3& w) { return std::abs(radius(w) - along.norm()) <= near; };
  planes.add_bisectors(first, like_first);

  // Planes that keep the first vertex; the second one is moved or kept.
  const auto off_axis = [&](const Vec3& p) { return along.cross(p - c).norm(); };
  const Vec3 second = farthest(points, off_axis);
  const auto like_second = [&](const Vec3& w) {
    return std::abs(radius(w) - radius(second)) <= near &&
           std::abs((w - second).dot(along)) <= near;
  };
  planes.add_bisectors(second, like_second);
  planes.add(along.cross(second - c));
  return std::move(planes.found);
}

}  // namespace fairing
