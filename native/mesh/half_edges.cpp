// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/half_edges.h"

#include <algorithm>

#include "mesh/counting_sort.h"

namespace fairing {

HalfEdges::HalfEdges(const PolygonMesh& mesh)
    : mesh_(mesh), face_(mesh.corners.size()), twin_(mesh.corners.size(), -1) {
  for (const std::int64_t f : Cancellable(mesh.face_count())) {
    std::fill(face_.begin() + mesh.offsets[f], face_.begin() + mesh.offsets[std::size_t(f) + 1],
              std::int32_t(f));
  }
  find_twins();
}

std::int32_t HalfEdges::next(std::int32_t k) const {
  const auto f = std::size_t(face(k));
  return k + 1 == mesh_.offsets[f + 1] ? std::int32_t(mesh_.offsets[f]) : k + 1;
}

std::int32_t HalfEdges::previous(std::int32_t k) const {
  const auto f = std::size_t(face(k));
  return k == mesh_.offsets[f] ? std::int32_t(mesh_.offsets[f + 1]) - 1 : k - 1;
}

// Sorts half-edges by lower vertices, into groups of about three, and those by higher vertices.
void HalfEdges::find_twins() {
  struct Side {
    std::int32_t high, half_edge;
  };
  const auto ends = [&](std::size_t k) {
    return std::minmax({from(std::int32_t(k)), from(next(std::int32_t(k)))});
  };
  CountingSort<Side> sides(
      std::size_t(mesh_.vertex_count()), face_.size(), [&](std::size_t k) { return ends(k).first; },
      [&](std::size_t k) { return Side{std::int32_t(ends(k).second), std::int32_t(k)}; });
  sides.for_equal([](const Side& a, const Side& b) { return a.high < b.high; },
                  [&](std::span<const Side> edge) {
                    if (edge.size() == 2) {
                      twin_[edge[0].half_edge] = edge[1].half_edge;
                      twin_[edge[1].half_edge] = edge[0].half_edge;
                    } else if (edge.size() > 2) {
                      const auto [low, high] = ends(std::size_t(edge[0].half_edge));
                      nonmanifold_edges_.insert(nonmanifold_edges_.end(), {low, high});
                      nonmanifold_sides_ += std::int64_t(edge.size());
                    }
                  });
}

}  // namespace fairing
