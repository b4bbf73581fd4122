// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/opposite.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/BVH>

#include "base/angle.h"
#include "base/points.h"
#include "base/roundoff.h"

namespace fairing {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

struct Corners {
  std::array<Vec3, 3> at;
  Index face;
};

Eigen::AlignedBox3d bounding_box(const Corners& triangle) {
  Eigen::AlignedBox3d box(triangle.at[0]);
  return box.extend(triangle.at[1]).extend(triangle.at[2]);
}

// Finds the next triangle along a ray (Eigen's BVMinimize).
struct Ray {
  using Scalar = double;  // required by Eigen
  Vec3 from, along;
  Index face;  // at the start of the ray
  std::span<const FacePlane> planes;
  Opposite next{};

  double minimumOnVolume(const Eigen::AlignedBox3d& box) const {
    double enters = 0, leaves = none;
    for (Eigen::Index a = 0; a < 3; ++a) {
      const double one = (box.min()[a] - from[a]) / along[a],
                   other = (box.max()[a] - from[a]) / along[a];
      if (std::isnan(one) || std::isnan(other)) continue;  // along a side of the box
      enters = std::max(enters, std::min(one, other));
      leaves = std::min(leaves, std::max(one, other));
    }
    return enters <= leaves ? enters : none;
  }

  // As in [Möller and Trumbore 1997]; the sides belong to the triangle.
  double minimumOnObject(const Corners& triangle) {
    if (triangle.face == face || !(planes[triangle.face].normal.dot(along) > 0)) return none;
    const Vec3 u = triangle.at[1] - triangle.at[0], v = triangle.at[2] - triangle.at[0];
    const Vec3 across = along.cross(v), offset = from - triangle.at[0], turned = offset.cross(u);
    const double determinant = u.dot(across);
    const double first = offset.dot(across) / determinant, second = along.dot(turned) / determinant,
                 distance = v.dot(turned) / determinant;
    const bool hits = std::min({first, second, 1 - first - second}) >= -roundoff;
    if (!hits || !(distance > roundoff)) return none;
    if (distance < next.distance) next = {triangle.face, distance};
    return distance;
  }
};

// Positive if the faces are oriented outwards.
double six_volumes(std::span<const FacePlane> planes) {
  Vec3 centre = Vec3::Zero();
  for (const FacePlane& plane : planes) centre += plane.middle / double(planes.size());
  double sum = 0;
  for (const FacePlane& plane : planes) sum += plane.area * plane.normal.dot(plane.middle - centre);
  return sum;
}

}  // namespace

FacePlane plane_of(const Face& face, std::span<const Vec3> control) {
  const auto corner = [&](std::size_t i) { return control[face.vertex[i]]; };
  const Vec3 a = corner(0), b = corner(1), c = corner(2);
  if (!face.quad()) {
    const Vec3 cross = (b - a).cross(c - a);
    return {(a + b + c) / 3, unit_or_zero(cross), cross.norm() / 2};
  }
  const Vec3 d = corner(3), cross = (c - a).cross(d - b);
  return {(a + b + c + d) / 4, unit_or_zero(cross), cross.norm() / 2};
}

bool in_one_plane(const FacePlane& a, const FacePlane& b) {
  const double turn = angle_between(a.normal, b.normal);
  return turn * turn < single_roundoff;
}

std::vector<Opposite> opposite_faces(const ControlMesh& mesh, std::span<const Vec3> control,
                                     std::span<const FacePlane> planes, Workers& workers) {
  std::vector<Corners> triangles;
  for (const Index f : Cancellable(mesh.first_copied_face())) {
    const Face& face = mesh.faces[f];
    for (std::size_t i = 2; i < std::size_t(face.size); ++i)
      triangles.push_back(
          {{control[face.vertex[0]], control[face.vertex[i - 1]], control[face.vertex[i]]}, f});
  }
  const Eigen::KdBVH<double, 3, Corners> tree(triangles.begin(), triangles.end());
  const double inwards = six_volumes(planes) < 0 ? 1 : -1;
  std::vector<Opposite> out(mesh.faces.size());
  workers.for_each(std::size_t(mesh.first_copied_face()), 64, [&](std::size_t f) {
    Ray ray{planes[f].middle, inwards * planes[f].normal, Index(f), planes};
    Eigen::BVMinimize(tree, ray);
    out[f] = ray.next;
  });
  return out;
}

}  // namespace fairing
