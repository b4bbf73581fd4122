// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fill/rims.h"

#include "base/points.h"
#include "mesh/polygon_shape.h"
#include "parallel/cancel.h"

namespace fairing {

Rims::Rims(const PolygonMesh& mesh, const HalfEdges& half_edges, std::span<const Hole> holes)
    : mesh_(mesh) {
  std::vector<std::uint8_t> marked(std::size_t(mesh.vertex_count()), 0);
  for (const Hole& hole : holes)
    for (const HoleLoop& loop : hole)
      for (const std::int64_t v : loop) marked[v] = 1;
  for (const std::int32_t k : Cancellable(half_edges.count())) {
    if (!marked[half_edges.from(k)]) continue;
    const std::int64_t a = half_edges.from(k), b = half_edges.from(half_edges.next(k));
    if (!marked[b]) continue;
    edges_.insert(key(a, b));
    if (half_edges.twin(k) < 0) border_[side(a, b)] = half_edges.face(k);
  }
}

Vec3 Rims::point(std::int64_t v) const { return point_at(mesh_.coordinates, v); }

Vec3 Rims::normal_beside(std::int64_t a, std::int64_t b) const {
  return unit_or_zero(twice_vector_area(mesh_, border_.at(side(a, b))));
}

}  // namespace fairing
