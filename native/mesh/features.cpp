// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/error.h"
#include "mesh/chains.h"
#include "mesh/polygon_shape.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

Index other_end(const Edge& edge, Index v) {
  return edge.vertex[0] == v ? edge.vertex[1] : edge.vertex[0];
}

std::vector<Vec3> polygon_normals(const PolygonMesh& mesh) {
  std::vector<Vec3> normals;
  for (const std::int64_t f : Cancellable(mesh.face_count())) {
    normals.push_back(twice_vector_area(mesh, f));
  }
  return normals;
}

class FeatureFinder {
 public:
  FeatureFinder(const PolygonMesh& mesh, const FeatureOptions& options, ControlMesh& control)
      : mesh_(mesh), options_(options), control_(control), chains_(control) {}

  void find() {
    control_.feature_edge.assign(control_.edges.size(), 0);
    control_.feature_vertex.assign(std::size_t(control_.vertex_count()), 0);
    choose_modes();
    mark_boundary();
    mark_given_creases();
    mark_folded_edges();
    mark_copies();
    mark_corners();
    weigh_soft_creases();
    collect_chains();
  }

 private:
  // Edges outside a region are always straight lines; those on its joint are straight creases.
  bool feature(Index e) const {
    return control_.feature_edge[e] != 0 && control_.edge_part(e) != RegionPart::outside;
  }
  bool curve(Index e) const { return feature(e) && control_.edge_part(e) == RegionPart::inside; }
  const Edge& edge(Index e) const { return control_.edges[e]; }
  const Vec3& position(Index v) const { return control_.positions[v]; }
  // Normal of the polygon on a side; its length is twice the area.
  Vec3 normal(const std::vector<Vec3>& of_polygons, Index side) const {
    const Index f = control_.sides[side].face;
    const Vec3& normal = of_polygons[control_.faces[f].polygon];
    return control_.second_face(f) ? Vec3(-normal) : normal;
  }

  void choose_modes() {
    mode_.assign(std::size_t(control_.first_copied_edge()), options_.boundary);
    for (std::size_t m = 0; m < boundary_modes; ++m)
      for_each_edge(
          options_.boundary_edges[m], "boundary edges", "boundary edge",
          [&](Index e, std::size_t) { mode_[control_.original_edge(e)] = BoundaryMode(m); });
  }
  BoundaryMode mode(Index e) const { return mode_[control_.original_edge(e)]; }
  bool straight(Index e) const {
    return edge(e).boundary() && !control_.nonmanifold(e) && mode(e) == BoundaryMode::linear;
  }

  // Edges where sheets meet are always boundaries: other curves have at most two faces.
  void mark_boundary() {
    for (Index e = 0; e < Index(control_.edges.size()); ++e)
      control_.feature_edge[e] =
          control_.nonmanifold(e) || (edge(e).boundary() && mode(e) != BoundaryMode::free);
  }

  // The edge between two input vertices, one of the edges if it is non-manifold; -1: none.
  Index find_edge(Index a, Index b) const {
    if (control_.ring(a).size() > control_.ring(b).size()) std::swap(a, b);
    Index found = -1;
    control_.for_each_copy(a, [&](Index v) {
      for (const Spoke& spoke : control_.ring(v))
        if (found < 0 && control_.original_vertex(other_end(edge(spoke.edge), v)) == b &&
            !control_.inside_polygon(spoke.edge))
          found = spoke.edge;
    });
    return found;
  }

  // Both sides of a double cover have the same creases.
  void mark_copies() {
    for (Index e = control_.first_copied_edge(); e < Index(control_.edges.size()); ++e) {
      std::uint8_t& original = control_.feature_edge[control_.original_edge(e)];
      control_.feature_edge[e] = original |= control_.feature_edge[e];
    }
  }

  void mark_given_creases() {
    const auto mark = [&](Index e) { control_.feature_edge[e] = 1; };
    for_each_edge(options_.crease_edges, "crease edges", "crease",
                  [&](Index e, std::size_t) { mark(e); });
    const auto& [pairs, weights] = options_.soft_creases;
    if (pairs.empty()) return;
    control_.soft.edge.assign(control_.edges.size(), 0);
    for_each_edge(pairs, "soft creases", "soft crease", [&](Index e, std::size_t k) {
      if (weights[k] >= 1)
        mark(e);
      else
        control_.soft.edge[control_.original_edge(e)] = weights[k];
    });
  }

  // Call it once all creases are known.
  void weigh_soft_creases() {
    SoftCreases& soft = control_.soft;
    bool any = false;
    for (std::size_t e = 0; e < soft.edge.size(); ++e) {
      soft.edge[e] = control_.feature_edge[e] || control_.edges[e].boundary()
                         ? 0
                         : soft.edge[control_.original_edge(Index(e))];
      any |= soft.edge[e] > 0;
    }
    if (!any) soft = {};
    if (!any) return;
    for (Index v = 0; v < control_.vertex_count(); ++v) soft.vertex.push_back(soft_at(v));
  }

  double soft_at(Index v) const {
    double sum = 0;
    int count = 0;
    bool at_crease = false;
    for (const Spoke& spoke : control_.ring(v)) {
      const double weight = control_.soft.edge[spoke.edge];
      sum += weight;
      count += weight > 0;
      at_crease |= control_.feature_edge[spoke.edge] && !edge(spoke.edge).boundary();
    }
    if (count == 0) return 0;
    if (at_crease) return 1;
    return count > 1 || !control_.interior(v) ? sum / count : 0;
  }

  // Calls visit(e, place in `pairs`) for the caller's edges; `where` and `noun` are for messages.
  template <class Visit>
  void for_each_edge(const std::vector<std::array<std::int64_t, 2>>& pairs, const char* where,
                     const char* noun, Visit&& visit) const {
    std::vector<std::int64_t> unknown_vertices, unknown_edges;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto [a, b] = pairs[k];
      const auto outside = [&](std::int64_t v) { return v < 0 || v >= control_.input_vertices; };
      if (outside(a)) unknown_vertices.push_back(a);
      if (outside(b)) unknown_vertices.push_back(b);
      if (outside(a) || outside(b)) continue;
      const Index e = find_edge(Index(a), Index(b));
      if (e < 0)
        unknown_edges.insert(unknown_edges.end(), {a, b});
      else
        visit(e, k);
    }
    refuse_unknown(unknown_vertices, where);
    if (!unknown_edges.empty())
      throw FairingError(ErrorCode::bad_feature_edge,
                         "{" + std::string(noun) +
                             "} {joins|join}"
                             " two vertices between which the mesh has no edge (vertex pairs).",
                         unknown_edges);
  }

  void refuse_unknown(const std::vector<std::int64_t>& vertices, const char* where) const {
    if (vertices.empty()) return;
    throw FairingError(ErrorCode::index_out_of_range,
                       std::string("{vertex} {is|are} named among the ") + where +
                           " but not in the mesh: ids run from 0 to " +
                           std::to_string(control_.input_vertices - 1) + ".",
                       vertices, ElementKind::vertex);
  }

  void mark_folded_edges() {
    if (options_.crease_angle < 0) return;
    const std::vector<Vec3> normals = polygon_normals(mesh_);
    for (const std::size_t e : Cancellable(control_.edges.size())) {
      const Edge& edge = control_.edges[e];
      if (edge.boundary() || control_.inside_polygon(Index(e))) continue;
      const Vec3 left = normal(normals, edge.side[0]), right = normal(normals, edge.side[1]);
      // Arcs of three chords fold by 30 degrees exactly: rounding must not crease some of the edges.
      const double rounding = turn_of_rounding(position(edge.vertex[0]), position(edge.vertex[1]));
      if (angle_between(left, right) > options_.crease_angle + rounding)
        control_.feature_edge[e] = 1;
    }
  }

  bool turns_sharply(Index v, Index before, Index after) const {
    if (options_.corner_angle < 0) return false;
    const Vec3 in = position(v) - position(chains_.across(before, v));
    const Vec3 out = position(chains_.across(after, v)) - position(v);
    return angle_between(in, out) > options_.corner_angle;
  }

  // A curve ends at v if no other curve continues it, if the sheets that meet along it change, or
  // if it becomes straight.
  bool ends(Index v, const std::vector<Index>& edges) const {
    return edges.size() != 2 || straight(edges[0]) != straight(edges[1]) ||
           control_.vertex_part(v) == RegionPart::joint ||
           control_.nonmanifold(edges[0]) != control_.nonmanifold(edges[1]) ||
           turns_sharply(v, edges[0], edges[1]);
  }

  void mark_corners() {
    for (Index e = 0; e < Index(chains_.on.size()); ++e) chains_.on[e] = feature(e);
    for (const Index v : Cancellable(control_.vertex_count())) {
      if (chains_.joined.first(v) != v) continue;
      const std::vector<Index>& edges = chains_.at(v);
      chains_.corner[v] = !edges.empty() && ends(v, edges);
      chains_.joined.for_each(v, [&](Index w) { control_.feature_vertex[w] = !edges.empty(); });
    }
    std::vector<std::int64_t> unknown;
    for (std::int64_t v : options_.corner_vertices) {
      if (v < 0 || v >= control_.input_vertices) {
        unknown.push_back(v);
        continue;
      }
      control_.for_each_copy(Index(v), [&](Index w) {
        control_.feature_vertex[w] = chains_.corner[chains_.joined.first(w)] = 1;
      });
    }
    refuse_unknown(unknown, "corners");
  }

  void collect_chains() {
    for (Index e = 0; e < Index(chains_.on.size()); ++e) chains_.on[e] = curve(e);
    chains_.collect();
    for (Chain& chain : control_.chains) chain.straight = straight(chain.edges[0]);
    control_.feature_chains = control_.chains.size();
  }

  const PolygonMesh& mesh_;
  const FeatureOptions& options_;
  ControlMesh& control_;
  ChainFinder chains_;
  std::vector<BoundaryMode> mode_;  // for edges that are not copies
};

}  // namespace

void find_features(const PolygonMesh& mesh, const FeatureOptions& options, ControlMesh& control) {
  FeatureFinder(mesh, options, control).find();
}

}  // namespace fairing
