// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fill/rims.h"

#include <Eigen/Geometry>

#include "parallel/cancel.h"

namespace fairing {

Rims::Rims(const PolygonMesh& mesh, const HalfEdges& half_edges, std::span<const Hole> holes)
    : mesh_(mesh) {
  std::vector<std::uint8_t> marked(std::size_t(mesh.vertex_count()), 0);
  for (const Hole& hole : holes)
    for (const HoleLoop& loop : hole)
      for (const std::int64_t v : loop) marked[std::size_t(v)] = 1;
  for (std::int32_t k = 0; k < half_edges.count(); ++k) {
    stop_if_cancelled(std::size_t(k));
    if (!marked[std::size_t(half_edges.from(k))]) continue;
    const std::int64_t a = half_edges.from(k), b = half_edges.from(half_edges.next(k));
    if (!marked[std::size_t(b)]) continue;
    edges_.insert(key(a, b));
    if (half_edges.twin(k) < 0) border_[side(a, b)] = half_edges.face(k);
  }
}

Vec3 Rims::point(std::int64_t v) const {
  const double* p = mesh_.coordinates.data() + 3 * v;
  return {p[0], p[1], p[2]};
}

Vec3 Rims::normal_beside(std::int64_t a, std::int64_t b) const {
  const auto corners = mesh_.face(border_.at(side(a, b)));
  const Vec3 origin = point(corners[0]);
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += (point(corners[i]) - origin).cross(point(corners[i + 1]) - origin);
  const double length = sum.norm();
  return length > 0 ? Vec3(sum / length) : Vec3(Vec3::Zero());
}

}  // namespace fairing
