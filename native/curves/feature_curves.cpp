// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/feature_curves.h"

#include <algorithm>

#include "curves/straight.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

std::vector<Vec3> straight_points(std::span<const Vec3> vertices, bool closed, int subdivisions) {
  std::vector<Vec3> points;
  for (std::size_t s = 0; s < (closed ? vertices.size() : vertices.size() - 1); ++s) {
    // Each edge separately, so that other vertices of the chain have no influence.
    const Vec3 ends[2] = {vertices[s], vertices[(s + 1) % vertices.size()]};
    const bool backwards = std::lexicographical_compare(ends[1].data(), ends[1].data() + 3,
                                                        ends[0].data(), ends[0].data() + 3);
    const Vec3 &a = ends[backwards], &b = ends[!backwards];
    for (int k = 1; k < subdivisions; ++k) {
      const int from_a = backwards ? subdivisions - k : k;
      points.push_back(a + (double(from_a) / subdivisions) * (b - a));
    }
  }
  return points;
}

FeatureCurves refine_chains(const ControlMesh& mesh, std::span<const Vec3> parameters,
                            std::span<const Vec3> positions, const CurveScheme& scheme) {
  const bool own = positions.data() == parameters.data();
  FeatureCurves curves;
  curves.points_per_edge = scheme.subdivisions - 1;
  curves.run.assign(mesh.edges.size(), -1);
  const auto inner = std::size_t(curves.points_per_edge);
  Index runs = 0;
  for (const Chain& chain : mesh.chains) {
    stop_if_cancelled();
    std::vector<Vec3> vertices, parameter_vertices;
    for (Index v : chain.vertices) {
      vertices.push_back(positions[v]);
      parameter_vertices.push_back(parameters[v]);
    }
    std::vector<Vec3> points =
        chain.straight
            ? straight_points(vertices, chain.closed, scheme.subdivisions)
            : refine_chain(own ? vertices : parameter_vertices, vertices, chain.closed, scheme);
    for (std::size_t k = 0; k < chain.edges.size(); ++k) {
      const auto edge = std::size_t(chain.edges[k]);
      curves.run[edge] = runs++;
      const auto begin = points.begin() + k * inner;
      if (mesh.original_vertex(mesh.edges[edge].vertex[0]) != chain.vertices[k])
        std::reverse(begin, begin + std::ptrdiff_t(inner));
    }
    curves.points.insert(curves.points.end(), points.begin(), points.end());
  }
  for (Index e = mesh.first_copied_edge(); e < Index(mesh.edges.size()); ++e)
    curves.run[e] = curves.run[mesh.original_edge(e)];
  return curves;
}

}  // namespace

void straighten(const ControlMesh& mesh, std::span<const Index> edges,
                std::span<const Vec3> positions, FeatureCurves& curves) {
  for (const Index e : edges) {
    const auto& ends = mesh.edges[e].vertex;
    const Vec3 chord[2] = {positions[ends[0]], positions[ends[1]]};
    const std::vector<Vec3> points = straight_points(chord, false, curves.points_per_edge + 1);
    std::copy(points.begin(), points.end(),
              curves.points.begin() +
                  std::ptrdiff_t(curves.run[e]) * std::ptrdiff_t(curves.points_per_edge));
  }
}

FeatureCurves refine_feature_edges(const ControlMesh& mesh, std::span<const Vec3> parameters,
                                   std::span<const Vec3> positions, const CurveScheme& scheme) {
  FeatureCurves own = refine_chains(mesh, parameters, parameters, scheme);
  std::vector<Index> edges = edges_to_straighten(mesh, parameters, own);
  FeatureCurves curves = positions.data() == parameters.data()
                             ? std::move(own)
                             : refine_chains(mesh, parameters, positions, scheme);
  straighten(mesh, edges, positions, curves);
  curves.straightened = std::move(edges);
  return curves;
}

}  // namespace fairing
