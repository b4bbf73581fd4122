// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fill/holes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/points.h"
#include "mesh/mend/loops.h"
#include "mesh/union_find.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

constexpr std::int32_t none = -1;

// Steps along the border of the mesh, against its half-edges: so a hole is on the left.
class Walks {
 public:
  Walks(const PolygonMesh& mesh, const HalfEdges& half_edges)
      : half_edges_(half_edges), torn_(std::size_t(mesh.vertex_count()), 0) {
    const std::vector<std::int64_t>& edges = half_edges.nonmanifold_edges();
    for (const std::int64_t v : edges) torn_[v] = 1;
    for (std::size_t i = 0; i + 1 < edges.size(); i += 2)
      crowded_.insert(std::minmax(edges[i], edges[i + 1]));
    pair_across_gaps(mesh);
  }

  // Whether the half-edge has no other face, and bounds a hole: where an edge of more than two faces
  // ends, holes are not defined.
  bool is_border(std::int32_t k) const { return half_edges_.twin(k) < 0 && !is_torn(k); }

  // Whether an edge of more than two faces ends at an end of this half-edge.
  bool is_torn(std::int32_t k) const {
    return torn_[half_edges_.from(k)] || torn_[half_edges_.from(half_edges_.next(k))];
  }

  // The same, and the half-edge has no other face.
  bool is_torn_border(std::int32_t k) const {
    return half_edges_.twin(k) < 0 && is_torn(k) &&
           !crowded_.contains(
               std::minmax(half_edges_.from(k), half_edges_.from(half_edges_.next(k))));
  }

  // The half-edge of the border that follows in a walk: it ends where k begins, on the other side of
  // the gap there. None if the faces around have different orientations, or the border ends.
  std::int32_t onward(std::int32_t k) const {
    const auto across = across_.find(k);
    return across == across_.end() ? last_of_fan(k) : across->second;
  }

 private:
  // The half-edge of the border that ends where k begins, at the other end of the fan of faces.
  std::int32_t last_of_fan(std::int32_t k) const {
    std::int32_t at = half_edges_.previous(k);
    while (half_edges_.twin(at) >= 0) {
      if (half_edges_.runs_as_twin(at)) return none;
      at = half_edges_.previous(half_edges_.twin(at));
    }
    return is_border(at) ? at : none;
  }

  // If several fans of faces meet at a vertex, a gap leads from each to the next one around it.
  void pair_across_gaps(const PolygonMesh& mesh) {
    std::vector<std::uint8_t> fans(std::size_t(mesh.vertex_count()), 0);
    const auto count_at = [&](std::int32_t k) -> std::uint8_t& {
      return fans[half_edges_.from(k)];
    };
    for (std::int32_t k = 0; k < half_edges_.count(); ++k)
      if (is_border(k) && count_at(k) < 2) ++count_at(k);
    std::map<std::int64_t, std::vector<std::int32_t>> firsts;  // by vertex
    for (std::int32_t k = 0; k < half_edges_.count(); ++k)
      if (is_border(k) && count_at(k) == 2) firsts[half_edges_.from(k)].push_back(k);
    for (const auto& [v, fans_there] : firsts) pair_at(mesh, v, fans_there);
  }

  // Takes the fans in the order of the angles at which they begin. Does nothing if their orientations
  // differ.
  void pair_at(const PolygonMesh& mesh, std::int64_t v, const std::vector<std::int32_t>& firsts) {
    std::vector<Vec3> normals, ways;
    Vec3 sum = Vec3::Zero();
    const auto way_to = [&](std::int64_t other) {
      return Vec3(point_at(mesh.coordinates, other) - point_at(mesh.coordinates, v));
    };
    for (const std::int32_t first : firsts) {
      const std::int32_t last = last_of_fan(first);
      if (last == none) return;
      Vec3 normal = Vec3::Zero();
      for (std::int32_t k = first;; k = half_edges_.twin(half_edges_.previous(k))) {
        normal += unit_or_zero(way_to(half_edges_.from(half_edges_.next(k)))
                                   .cross(way_to(half_edges_.from(half_edges_.previous(k)))));
        if (half_edges_.previous(k) == last) break;
      }
      normals.push_back(normal), sum += normal;
      ways.push_back(way_to(half_edges_.from(half_edges_.next(first))));
    }
    for (const Vec3& normal : normals)
      if (normal.dot(sum) <= 0) return;
    const Vec3 axis = sum.normalized(), x = axis.cross(ways[0].cross(axis)), y = axis.cross(x);
    std::vector<std::pair<double, std::int32_t>> around;
    for (std::size_t i = 0; i < firsts.size(); ++i)
      around.emplace_back(std::atan2(ways[i].dot(y), ways[i].dot(x)), firsts[i]);
    std::sort(around.begin(), around.end());
    for (std::size_t i = 0; i < around.size(); ++i)
      across_[around[(i + 1) % around.size()].second] = last_of_fan(around[i].second);
  }

  const HalfEdges& half_edges_;
  std::map<std::int32_t, std::int32_t> across_;  // the next half-edge where several fans meet
  std::vector<std::uint8_t> torn_;  // vertices where an edge of more than two faces ends
  std::set<std::pair<std::int64_t, std::int64_t>> crowded_;  // edges of more than two faces
};

HoleLoop from_least(const Loop& loop) {
  HoleLoop found;
  for (const MendCorner& corner : loop) found.push_back(corner.vertex);
  std::rotate(found.begin(), std::min_element(found.begin(), found.end()), found.end());
  return found;
}

FairingError why_unclear(bool torn, std::vector<std::int64_t> edges) {
  if (torn)
    return {ErrorCode::nonmanifold_edge,
            {"More than two faces meet beside {edge}, so holes are not defined.",
             "Delete the surplus faces."},
            std::move(edges)};
  return {ErrorCode::inconsistent_orientation,
          {"Faces point different ways beside {edge}, so holes are not defined.",
           "Recalculate their normals."},
          std::move(edges),
          ElementKind::edge};
}

// Why these half-edges bound no hole: one error for those that are connected.
std::vector<FairingError> unclear(const std::vector<std::int32_t>& left, const Walks& walks,
                                  const HalfEdges& half_edges) {
  UnionFind groups(left.size());
  std::map<std::int64_t, Index> at;  // from a vertex to its first edge
  const auto ends = [&](std::size_t i) {
    return std::pair<std::int64_t, std::int64_t>(half_edges.from(half_edges.next(left[i])),
                                                 half_edges.from(left[i]));
  };
  for (std::size_t i = 0; i < left.size(); ++i)
    for (const std::int64_t v : {ends(i).first, ends(i).second}) {
      const auto [other, is_new] = at.try_emplace(v, Index(i));
      if (!is_new) groups.unite(Index(i), other->second);
    }
  std::map<Index, std::pair<bool, std::vector<std::int64_t>>> edges;
  for (std::size_t i = 0; i < left.size(); ++i) {
    auto& [torn, ids] = edges[groups.lead(Index(i))];
    torn |= walks.is_torn(left[i]);
    ids.insert(ids.end(), {ends(i).first, ends(i).second});
  }
  std::vector<FairingError> found;
  for (auto& [lead, group] : edges)
    found.push_back(why_unclear(group.first, std::move(group.second)));
  return found;
}

FairingError too_long_loop(const HoleLoop& loop) {
  std::vector<std::int64_t> edges;
  for (std::size_t i = 0; i < loop.size(); ++i)
    edges.insert(edges.end(), {loop[i], loop[(i + 1) % loop.size()]});
  return {ErrorCode::too_large, too_long_text(loop.size()), std::move(edges), ElementKind::edge};
}

}  // namespace

std::string too_long_text(std::size_t vertices) {
  return "The hole has " + std::to_string(vertices) +
         " vertices; more than 16,384 cannot be filled.";
}

FoundHoles find_holes(const PolygonMesh& mesh, const HalfEdges& half_edges) {
  const Walks walks(mesh, half_edges);
  std::vector<std::uint8_t> seen(std::size_t(half_edges.count()), 0);
  FoundHoles found;
  std::vector<std::int32_t> left;
  for (const std::int32_t first : Cancellable(half_edges.count())) {
    if (seen[first] || !walks.is_border(first)) continue;
    Loop walk;
    std::vector<std::int32_t> sides;
    bool one_face = true;
    std::int32_t k = first;
    while (k != none && !seen[k]) {
      seen[k] = 1;
      one_face &= half_edges.face(k) == half_edges.face(first);
      walk.push_back({Index(half_edges.from(k)), {}});
      sides.push_back(k);
      k = walks.onward(k);
    }
    if (k != first) left.insert(left.end(), sides.begin(), sides.end());
    if (k != first || one_face) continue;
    for (const Loop& loop : simple_loops(walk)) {
      HoleLoop ids = from_least(loop);
      if (ids.size() > longest_hole)
        found.unclear.push_back(too_long_loop(ids));
      else
        found.loops.push_back(std::move(ids));
    }
  }
  for (std::int32_t k = 0; k < half_edges.count(); ++k)
    if (walks.is_torn_border(k)) left.push_back(k);
  std::sort(found.loops.begin(), found.loops.end());
  std::sort(left.begin(), left.end());
  for (FairingError& why : unclear(left, walks, half_edges))
    found.unclear.push_back(std::move(why));
  return found;
}

}  // namespace fairing
