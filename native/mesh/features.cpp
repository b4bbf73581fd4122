// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Index other_end(const Edge& edge, Index v) {
  return edge.vertex[0] == v ? edge.vertex[1] : edge.vertex[0];
}

std::vector<Vec3> polygon_normals(const PolygonMesh& mesh) {
  std::vector<Vec3> normals(std::size_t(mesh.face_count()), Vec3::Zero());
  for (std::int64_t f = 0; f < mesh.face_count(); ++f) {
    stop_if_cancelled(std::size_t(f));
    const auto face = mesh.face(f);
    const auto point = [&](std::size_t i) -> Vec3 {
      return Eigen::Map<const Vec3>(&mesh.coordinates[3 * std::size_t(face[i])]);
    };
    for (std::size_t i = 1; i + 1 < face.size(); ++i)
      normals[std::size_t(f)] += (point(i) - point(0)).cross(point(i + 1) - point(0));
  }
  return normals;
}

class FeatureFinder {
 public:
  FeatureFinder(const PolygonMesh& mesh, const FeatureOptions& options, ControlMesh& control)
      : mesh_(mesh),
        options_(options),
        control_(control),
        corner_(std::size_t(control.vertex_count()), 0) {}

  void find() {
    control_.feature_edge.assign(control_.edges.size(), 0);
    control_.feature_vertex.assign(std::size_t(control_.vertex_count()), 0);
    mark_boundary();
    mark_given_creases();
    mark_folded_edges();
    mark_corners();
    collect_chains();
  }

 private:
  // Outside a region edges are straight lines, whatever is asked for; on its joint they are
  // straight creases.
  bool feature(Index e) const {
    return control_.feature_edge[std::size_t(e)] != 0 &&
           control_.edge_part(e) != RegionPart::outside;
  }
  bool curve(Index e) const { return feature(e) && control_.edge_part(e) == RegionPart::inside; }
  const Edge& edge(Index e) const { return control_.edges[std::size_t(e)]; }
  const Vec3& position(Index v) const { return control_.positions[std::size_t(v)]; }
  Index polygon(Index side) const {
    return control_.faces[std::size_t(control_.sides[std::size_t(side)].face)].polygon;
  }
  // Cut by split_polygons: no edge of the input.
  bool inside_polygon(const Edge& e) const {
    return !e.boundary() && polygon(e.side[0]) == polygon(e.side[1]);
  }

  void mark_boundary() {
    if (options_.boundary == BoundaryMode::free) return;
    for (std::size_t e = 0; e < control_.edges.size(); ++e)
      control_.feature_edge[e] = control_.edges[e].boundary();
  }

  Index find_edge(Index a, Index b) const {
    if (control_.ring(a).size() > control_.ring(b).size()) std::swap(a, b);
    for (const Spoke& spoke : control_.ring(a))
      if (other_end(edge(spoke.edge), a) == b) return spoke.edge;
    return -1;
  }

  void mark_given_creases() {
    std::vector<std::int64_t> unknown_vertices, unknown_edges;
    for (const auto& [a, b] : options_.crease_edges) {
      const auto outside = [&](std::int64_t v) { return v < 0 || v >= control_.input_vertices; };
      if (outside(a)) unknown_vertices.push_back(a);
      if (outside(b)) unknown_vertices.push_back(b);
      if (outside(a) || outside(b)) continue;
      const Index e = find_edge(Index(a), Index(b));
      if (e < 0 || inside_polygon(edge(e)))
        unknown_edges.insert(unknown_edges.end(), {a, b});
      else
        control_.feature_edge[std::size_t(e)] = 1;
    }
    refuse_unknown(unknown_vertices, "crease edges");
    if (!unknown_edges.empty())
      throw FairingError(ErrorCode::bad_feature_edge,
                         listing_pairs({"crease", "creases"}, unknown_edges, {"joins", "join"}) +
                             " two vertices between which the mesh has no edge (vertex pairs).",
                         unknown_edges);
  }

  void refuse_unknown(const std::vector<std::int64_t>& vertices, const char* where) const {
    if (vertices.empty()) return;
    throw FairingError(ErrorCode::index_out_of_range,
                       listing(vertex_s, vertices, {"is", "are"}) + " named among the " + where +
                           " but not in the mesh: ids run from 0 to " +
                           std::to_string(control_.input_vertices - 1) + ".",
                       vertices, ElementKind::vertex);
  }

  void mark_folded_edges() {
    if (options_.crease_angle < 0) return;
    const std::vector<Vec3> normals = polygon_normals(mesh_);
    for (std::size_t e = 0; e < control_.edges.size(); ++e) {
      stop_if_cancelled(e);
      const Edge& edge = control_.edges[e];
      if (edge.boundary() || inside_polygon(edge)) continue;
      const Vec3 &left = normals[std::size_t(polygon(edge.side[0]))],
                 &right = normals[std::size_t(polygon(edge.side[1]))];
      if (angle_between(left, right) > options_.crease_angle) control_.feature_edge[e] = 1;
    }
  }

  // The feature edges at v, as far as two; -1 for none.
  std::array<Index, 2> feature_edges_at(Index v, int& count) const {
    std::array<Index, 2> found{-1, -1};
    count = 0;
    for (const Spoke& spoke : control_.ring(v)) {
      if (!feature(spoke.edge)) continue;
      if (count < 2) found[std::size_t(count)] = spoke.edge;
      ++count;
    }
    return found;
  }

  bool turns_sharply(Index v, const std::array<Index, 2>& edges) const {
    if (options_.corner_angle < 0) return false;
    const Vec3 in = position(v) - position(other_end(edge(edges[0]), v));
    const Vec3 out = position(other_end(edge(edges[1]), v)) - position(v);
    return angle_between(in, out) > options_.corner_angle;
  }

  void mark_corners() {
    for (Index v = 0; v < control_.vertex_count(); ++v) {
      stop_if_cancelled(std::size_t(v));
      int count = 0;
      const auto edges = feature_edges_at(v, count);
      control_.feature_vertex[std::size_t(v)] = count > 0;
      const bool ends = count != 2 || control_.vertex_part(v) == RegionPart::joint;
      corner_[std::size_t(v)] = count > 0 && (ends || turns_sharply(v, edges));
    }
    std::vector<std::int64_t> unknown;
    for (std::int64_t v : options_.corner_vertices) {
      if (v < 0 || v >= control_.input_vertices) {
        unknown.push_back(v);
        continue;
      }
      control_.feature_vertex[std::size_t(v)] = corner_[std::size_t(v)] = 1;
    }
    refuse_unknown(unknown, "corners");
  }

  void collect_chains() {
    std::vector<std::uint8_t> visited(control_.edges.size(), 0);
    for (Index v = 0; v < control_.vertex_count(); ++v) {
      if (!corner_[std::size_t(v)]) continue;
      for (const Spoke& spoke : control_.ring(v))
        if (curve(spoke.edge) && !visited[std::size_t(spoke.edge)])
          collect_chain(v, spoke.edge, visited);
    }
    for (Index e = 0; e < Index(control_.edges.size()); ++e)  // what no corner reaches are loops
      if (curve(e) && !visited[std::size_t(e)]) collect_chain(edge(e).vertex[0], e, visited);
  }

  void collect_chain(Index start, Index first_edge, std::vector<std::uint8_t>& visited) {
    Chain chain;
    chain.vertices.push_back(start);
    Index v = start, e = first_edge;
    for (;;) {
      visited[std::size_t(e)] = 1;
      chain.edges.push_back(e);
      v = other_end(edge(e), v);
      if (v == start && !corner_[std::size_t(v)]) {
        chain.closed = true;
        break;
      }
      chain.vertices.push_back(v);
      if (corner_[std::size_t(v)]) break;
      int count = 0;
      const auto edges = feature_edges_at(v, count);
      e = edges[0] == e ? edges[1] : edges[0];
    }
    chain.straight = options_.boundary == BoundaryMode::linear &&
                     std::all_of(chain.edges.begin(), chain.edges.end(),
                                 [&](Index k) { return edge(k).boundary(); });
    control_.chains.push_back(std::move(chain));
  }

  const PolygonMesh& mesh_;
  const FeatureOptions& options_;
  ControlMesh& control_;
  std::vector<std::uint8_t> corner_;
};

}  // namespace

void find_features(const PolygonMesh& mesh, const FeatureOptions& options, ControlMesh& control) {
  FeatureFinder(mesh, options, control).find();
}

}  // namespace fairing
