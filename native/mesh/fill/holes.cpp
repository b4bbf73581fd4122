// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fill/holes.h"

#include <algorithm>

#include "mesh/mend/loops.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

constexpr std::int32_t none = -1;

class Walks {
 public:
  Walks(const PolygonMesh& mesh, const HalfEdges& half_edges)
      : half_edges_(half_edges), torn_(std::size_t(mesh.vertex_count()), 0) {
    for (const std::int64_t v : half_edges.nonmanifold_edges()) torn_[std::size_t(v)] = 1;
  }

  // An edge of one face. At the ends of edges with more faces nobody could say what a hole is.
  bool is_border(std::int32_t k) const {
    return half_edges_.twin(k) < 0 && !torn_[std::size_t(half_edges_.from(k))] &&
           !torn_[std::size_t(half_edges_.from(half_edges_.next(k)))];
  }

  // The border's half-edge that ends where k begins, across the faces between; none where these
  // disagree, or the border ends.
  std::int32_t onward(std::int32_t k) const {
    std::int32_t at = half_edges_.previous(k);
    while (half_edges_.twin(at) >= 0) {
      if (half_edges_.runs_as_twin(at)) return none;
      at = half_edges_.previous(half_edges_.twin(at));
    }
    return is_border(at) ? at : none;
  }

 private:
  const HalfEdges& half_edges_;
  std::vector<std::uint8_t> torn_;
};

HoleLoop from_least(const Loop& loop) {
  HoleLoop found;
  for (const MendCorner& corner : loop) found.push_back(corner.vertex);
  std::rotate(found.begin(), std::min_element(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace

std::vector<HoleLoop> find_holes(const PolygonMesh& mesh, const HalfEdges& half_edges) {
  const Walks walks(mesh, half_edges);
  std::vector<std::uint8_t> seen(std::size_t(half_edges.count()), 0);
  std::vector<HoleLoop> found;
  for (std::int32_t first = 0; first < half_edges.count(); ++first) {
    stop_if_cancelled(std::size_t(first));
    if (seen[std::size_t(first)] || !walks.is_border(first)) continue;
    Loop walk;
    bool one_face = true;
    std::int32_t k = first;
    while (k != none && !seen[std::size_t(k)]) {
      seen[std::size_t(k)] = 1;
      one_face &= half_edges.face(k) == half_edges.face(first);
      walk.push_back({Index(half_edges.from(k)), {}});
      k = walks.onward(k);
    }
    if (k != first || one_face) continue;
    for (const Loop& loop : simple_loops(walk)) found.push_back(from_least(loop));
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace fairing
