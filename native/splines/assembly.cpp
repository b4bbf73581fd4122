// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/assembly.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/angle.h"
#include "splines/patch_data.h"

namespace fairing {
namespace {

// Where a patch has an edge.
struct EdgeUse {
  Index patch;
  int side;
};

// Edges are numbered curve by curve, halved ones in two.
struct EdgeNumbers {
  std::vector<Index> first;  // of each curve, and the end
  std::vector<std::vector<EdgeUse>> uses;

  EdgeNumbers(const Topology& topology, std::size_t curves) {
    Index count = 0;
    for (std::size_t c = 0; c < curves; ++c) {
      first.push_back(count);
      count += c < topology.edges.size() && topology.edges[c].halved ? 2 : 1;
    }
    first.push_back(count);
    uses.resize(std::size_t(count));
    for (std::size_t p = 0; p < topology.patches.size(); ++p)
      for (int s = 0; s < 4; ++s)
        for (const Index e : edges_of(topology.patches[p].side[std::size_t(s)]))
          uses[std::size_t(e)].push_back({Index(p), s});
  }

  int parts(Index curve) const { return first[std::size_t(curve) + 1] - first[std::size_t(curve)]; }
  // In the order of the side's own direction.
  std::vector<Index> edges_of(const PatchSide& side) const {
    const Index from = first[std::size_t(side.curve)];
    if (parts(side.curve) == 1) return {from};
    if (side.part == Part::first_half) return {from};
    if (side.part == Part::second_half) return {from + 1};
    return side.reversed ? std::vector<Index>{from + 1, from} : std::vector<Index>{from, from + 1};
  }
};

// A patch's normal at t of an edge that is part `part` of `parts` of its curve.
Vec3 normal_beside(const Topology& topology, const std::vector<FittedPatch>& patches,
                   const EdgeUse& use, int part, int parts, double t) {
  const PatchSide& side = topology.patches[std::size_t(use.patch)].side[std::size_t(use.side)];
  const double along = std::clamp(on_side(side, (part + t) / parts), 0.0, 1.0);
  return on_side(patches[std::size_t(use.patch)].patch, use.side, along).normal();
}

bool meets_smoothly(const Topology& topology, std::size_t curve) {
  return curve >= topology.edges.size() || topology.edges[curve].kind == EdgeKind::smooth;
}

// Whether t of a smooth curve is in the tip of such a kink or a sharper one: it has no normals
// there.
bool at_kink(const Topology& topology, const std::vector<FittedCurve>& curves, std::size_t c,
             double t, Kink least) {
  if (c >= topology.edges.size()) return false;
  const Index sector = topology.edges[c].sectors[t > 0.5 ? 1 : 0];
  if (topology.kinks[std::size_t(sector)] < least) return false;
  const FittedCurve& curve = curves[c];
  const auto& at = curve.parameters;
  const auto after = std::upper_bound(at.begin() + 1, at.end() - 1, t);
  const std::size_t k = std::size_t(after - at.begin());
  return curve.normals[k - 1].isZero() || curve.normals[k].isZero();
}

// At kinks that are `unjudged` or sharper there are none.
std::vector<double> angles_of(const Topology& topology, const std::vector<FittedPatch>& patches,
                              const std::vector<FittedCurve>& curves, const EdgeNumbers& numbers,
                              Kink unjudged, Workers& workers) {
  std::vector<double> angles(numbers.uses.size() * angles_an_edge,
                             std::numeric_limits<double>::quiet_NaN());
  workers.for_parts(numbers.first.size() - 1, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      if (!meets_smoothly(topology, c)) continue;
      const int parts = numbers.parts(Index(c));
      for (int part = 0; part < parts; ++part) {
        const std::size_t e = std::size_t(numbers.first[c] + part);
        const std::vector<EdgeUse>& uses = numbers.uses[e];
        if (uses.size() != 2) continue;
        for (int k = 0; k < angles_an_edge; ++k) {
          const double t = double(k) / (angles_an_edge - 1);
          if (at_kink(topology, curves, c, (part + t) / parts, unjudged)) continue;
          angles[e * angles_an_edge + std::size_t(k)] =
              angle_between(normal_beside(topology, patches, uses[0], part, parts, t),
                            normal_beside(topology, patches, uses[1], part, parts, t));
        }
      }
    }
  });
  return angles;
}

class VertexNumbers {
 public:
  explicit VertexNumbers(std::vector<Vec3>& at) : at_(at) {}
  // Keys: points of the lattice, and behind them the centroids of triangles.
  Index of(std::int64_t key, const Vec3& position) {
    const auto [found, is_new] = number_.try_emplace(key, Index(at_.size()));
    if (is_new) at_.push_back(position);
    return found->second;
  }

 private:
  std::vector<Vec3>& at_;
  std::unordered_map<std::int64_t, Index> number_;
};

}  // namespace

void assemble(const Lattice& lattice, const Topology& topology,
              const std::vector<FittedCurve>& curves, std::vector<FittedPatch>& patches,
              SplineSurface& out) {
  const EdgeNumbers numbers(topology, curves.size());
  VertexNumbers vertices(out.vertices);
  const auto add = [&](SplineCurve curve, EdgeKind kind, std::int64_t from, std::int64_t to,
                       double error) {
    const Index a = vertices.of(from, curve.points.front()),
                b = vertices.of(to, curve.points.back());
    curve.points.front() = out.vertices[std::size_t(a)];
    curve.points.back() = out.vertices[std::size_t(b)];
    out.edges.push_back({std::move(curve), kind, {a, b}, error});
  };
  const int n = lattice.n();
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    stop_if_cancelled(e);
    const ControlEdge& edge = topology.edges[e];
    const SideUse& use = edge.uses.front();
    const auto key = [&](int k) { return std::int64_t(lattice.point(use.face, use.side, k, 0)); };
    const FittedCurve& fitted = curves[e];
    if (!edge.halved) {
      add(fitted.curve, edge.kind, key(0), key(n), fitted.error);
      continue;
    }
    add(half_of(fitted.curve, false), edge.kind, key(0), key(n / 2), fitted.error);
    add(half_of(fitted.curve, true), edge.kind, key(n / 2), key(n), fitted.error);
  }
  for (std::size_t c = topology.edges.size(); c < curves.size(); ++c) {
    const std::size_t k = c - topology.edges.size(), f = k / 3;
    const Index middle = lattice.point(Index(f), int(k % 3), n / 2, 0);
    add(curves[c].curve, EdgeKind::smooth, middle, std::int64_t(lattice.points() + f),
        curves[c].error);
  }
  for (std::size_t p = 0; p < patches.size(); ++p) {
    stop_if_cancelled(p);
    const PatchPlace& place = topology.patches[p];
    std::vector<LoopEdge> loop;
    for (std::size_t s = 0; s < 4; ++s) {
      PatchSide side = place.side[s];
      if (s >= 2) side.reversed = !side.reversed;  // the loop runs against u and v there
      for (const Index e : numbers.edges_of(side)) loop.push_back({e, !side.reversed});
    }
    out.loops.push_back(std::move(loop));
    out.face.push_back(place.face);
    out.residual.push_back(patches[p].residual);
    out.turned.push_back(patches[p].turned);
    out.patches.push_back(std::move(patches[p].patch));
  }
  out.size = lattice.size();
}

std::vector<double> edge_angles(const Topology& topology, const std::vector<FittedPatch>& patches,
                                const std::vector<FittedCurve>& curves, Workers& workers) {
  return angles_of(topology, patches, curves, EdgeNumbers(topology, curves.size()), Kink::sharp,
                   workers);
}

std::vector<Directions> patches_to_refine(const Topology& topology,
                                          const std::vector<FittedPatch>& patches,
                                          const std::vector<FittedCurve>& curves, double tolerance,
                                          Workers& workers) {
  const EdgeNumbers numbers(topology, curves.size());
  const std::vector<double> angles =
      angles_of(topology, patches, curves, numbers, Kink::slight, workers);
  std::vector<Directions> wanted(patches.size());
  for (std::size_t e = 0; e < numbers.uses.size(); ++e) {
    stop_if_cancelled(e);
    double worst = 0;
    for (std::size_t k = 0; k < angles_an_edge; ++k)
      if (angles[e * angles_an_edge + k] > worst) worst = angles[e * angles_an_edge + k];
    if (worst <= tolerance) continue;
    const auto own = [&](const EdgeUse& use) {
      return patches[std::size_t(use.patch)].side_angle[std::size_t(use.side)];
    };
    const double larger = std::max(own(numbers.uses[e][0]), own(numbers.uses[e][1]));
    for (const EdgeUse& use : numbers.uses[e])
      if (own(use) >= std::min(larger, tolerance / 2))
        (use.side % 2 ? wanted[std::size_t(use.patch)].v : wanted[std::size_t(use.patch)].u) = true;
  }
  return wanted;
}

}  // namespace fairing
