// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/feature_curves.h"

#include <algorithm>
#include <map>
#include <utility>

#include "parallel/cancel.h"

namespace fairing {
namespace {

class NarrowFaces {
 public:
  NarrowFaces(const ControlMesh& mesh, std::span<const Vec3> positions, const FeatureCurves& curves)
      : mesh_(mesh),
        positions_(positions),
        curves_(curves),
        held_(positions.size(), 0),
        narrow_(curves.run.size(), 0) {
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
      for (const Index v : mesh.edges[e].vertex) held_[v] |= curves.run[e] >= 0;
  }

  std::vector<Index> edges() {
    for (const std::size_t s : Cancellable(mesh_.sides.size())) {
      const Side& side = mesh_.sides[s];
      if (curves_.run[side.edge] < 0) continue;
      const Face& face = mesh_.faces[side.face];
      if (!face.quad())
        check_triangle(side, face);
      else if (side.local < 2)
        check_quad(side, mesh_.sides[s + 2]);
    }
    return edges_of_narrow_runs();
  }

 private:
  struct Line {
    Vec3 from, to;
    Vec3 direction() const { return (to - from).normalized(); }
    Vec3 at(double t) const { return (1 - t) * from + t * to; }
  };

  static Vec3 across(const Vec3& v, const Vec3& direction) {
    return v - direction.dot(v) * direction;
  }
  Line chord(const Side& side) const {
    const auto& v = mesh_.edges[side.edge].vertex;
    const Vec3 &a = positions_[v[0]], &b = positions_[v[1]];
    return side.reversed ? Line{b, a} : Line{a, b};
  }
  // The offset of point k, counted along the side, from the edge.
  Vec3 bulge(const Side& side, int k) const {
    const int last = curves_.points_per_edge + 1;
    const Vec3& point = curves_.of(side.edge)[std::size_t(side.reversed ? last - k : k) - 1];
    return point - chord(side).at(double(k) / last);
  }
  void mark(const Side& side) { narrow_[curves_.run[side.edge]] = 1; }

  void check_triangle(const Side& side, const Face& face) {
    const Index corner = face.vertex[(side.local + 2) % 3];
    const Line line = chord(side);
    const Vec3 height = across(positions_[corner] - line.from, line.direction());
    for (int k = 1; k <= curves_.points_per_edge; ++k) {
      const Vec3 away = across(bulge(side, k), line.direction());
      const double into = away.dot(height.normalized());
      if ((held_[corner] ? away.norm() : into) > height.norm()) mark(side);
    }
  }

  void check_quad(const Side& side, const Side& opposite) {
    if (curves_.run[opposite.edge] < 0) return;
    const Line line = chord(side), beside = chord(opposite);
    const Vec3 direction = ((line.to - line.from) - (beside.to - beside.from)).normalized();
    const int last = curves_.points_per_edge + 1;
    for (int k = 1; k < last; ++k) {
      const double t = double(k) / last;
      const Vec3 width = across(beside.at(1 - t) - line.at(t), direction);
      const Vec3 apart = across(bulge(opposite, last - k) - bulge(side, k), direction);
      if (!(apart.norm() > width.norm())) continue;
      mark(side);
      mark(opposite);
    }
  }

  std::vector<Index> edges_of_narrow_runs() const {
    std::vector<Index> out;
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e)
      if (curves_.run[e] >= 0 && narrow_[curves_.run[e]]) out.push_back(Index(e));
    return out;
  }

  const ControlMesh& mesh_;
  std::span<const Vec3> positions_;
  const FeatureCurves& curves_;
  std::vector<std::uint8_t> held_;    // by control vertex: on a curve
  std::vector<std::uint8_t> narrow_;  // by run
};

// Control edges, ascending, whose curve leaves them by more than the width of an adjacent face: the
// face would be more than twice as wide, or turn over. If both sides of a quad are curves, only
// their bulges against each other count, because narrow faces may follow a bend. A triangle's
// corner that no curve holds may follow a curve that goes away from it.
std::vector<Index> edges_to_straighten(const ControlMesh& mesh, std::span<const Vec3> positions,
                                       const FeatureCurves& curves) {
  return NarrowFaces(mesh, positions, curves).edges();
}

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

// By chain: what lies beyond its ends, if it is a crease. Boundaries have nothing there: a mesh that
// shares one may go on in another way.
std::vector<Beyond> beyond_chains(const ControlMesh& mesh, std::span<const Vec3> positions) {
  std::multimap<Index, std::pair<const Chain*, Index>>
      ends;  // by vertex: its chains, their next one
  for (const Chain& chain : mesh.chains) {
    if (chain.closed) continue;
    ends.emplace(chain.vertices.front(), std::pair(&chain, chain.vertices[1]));
    ends.emplace(chain.vertices.back(), std::pair(&chain, *(chain.vertices.end() - 2)));
  }
  std::vector<Beyond> out(mesh.chains.size());
  for (std::size_t c = 0; c < out.size(); ++c) {
    const Chain& chain = mesh.chains[c];
    if (chain.closed || mesh.edges[chain.edges[0]].boundary()) continue;
    const auto collect = [&](Index end, std::vector<Vec3>& beyond) {
      for (auto [at, last] = ends.equal_range(end); at != last; ++at)
        if (at->second.first != &chain) beyond.push_back(positions[at->second.second]);
    };
    collect(chain.vertices.front(), out[c].first);
    collect(chain.vertices.back(), out[c].last);
  }
  return out;
}

FeatureCurves refine_chains(const ControlMesh& mesh, std::span<const Vec3> parameters,
                            std::span<const Vec3> positions, const CurveScheme& scheme) {
  const bool own = positions.data() == parameters.data();
  FeatureCurves curves;
  curves.points_per_edge = scheme.subdivisions - 1;
  curves.run.assign(mesh.edges.size(), -1);
  const auto inner = std::size_t(curves.points_per_edge);
  Index runs = 0;
  std::vector<Beyond> beyond = beyond_chains(mesh, parameters);
  for (std::size_t c = 0; c < mesh.chains.size(); ++c) {
    const Chain& chain = mesh.chains[c];
    stop_if_cancelled();
    std::vector<Vec3> vertices, parameter_vertices;
    for (Index v : chain.vertices) {
      vertices.push_back(positions[v]);
      parameter_vertices.push_back(parameters[v]);
    }
    std::vector<Vec3> points = chain.straight
                                   ? straight_points(vertices, chain.closed, scheme.subdivisions)
                                   : refine_chain(own ? vertices : parameter_vertices, vertices,
                                                  chain.closed, scheme, std::move(beyond[c]));
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
