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

// An edge of a patch.
struct EdgeUse {
  Index patch;
  int side;
};

// A curve from one cut to the next, in half edges of `all`.
struct EdgePart {
  std::size_t curve;
  int from, to, all;
  std::vector<EdgeUse> uses;

  double on_curve(double t) const { return (from + t * (to - from)) / all; }
};

class EdgeParts {
 public:
  explicit EdgeParts(const Fits& fits) {
    const Topology& topology = fits.topology;
    for (std::size_t c = 0; c < fits.curves.size(); ++c) {
      first_.push_back(Index(parts.size()));
      if (c >= topology.chains.size()) {
        parts.push_back({c, 0, 2, 2, {}});
        continue;
      }
      const EdgeChain& chain = topology.chains[c];
      for (std::size_t k = 1; k < chain.cuts.size(); ++k)
        parts.push_back({c, chain.cuts[k - 1], chain.cuts[k], chain.halves(), {}});
    }
    first_.push_back(Index(parts.size()));
    for (std::size_t p = 0; p < topology.patches.size(); ++p)
      for (int s = 0; s < 4; ++s)
        for (const Index e : of(topology.patches[p].side[s]))
          parts[e].uses.push_back({Index(p), s});
  }

  // In the direction of the side.
  std::vector<Index> of(const PatchSide& side) const {
    std::vector<Index> out;
    const auto c = std::size_t(side.curve);
    for (Index e = first_[c]; e < first_[c + 1]; ++e) {
      const EdgePart& part = parts[e];
      if (part.from >= side.from && part.to <= side.to) out.push_back(e);
    }
    if (side.reversed) std::reverse(out.begin(), out.end());
    return out;
  }

  std::vector<EdgePart> parts;

 private:
  std::vector<Index> first_;  // by curve, and the end
};

// The patch next to a curve, at t of the curve.
struct Beside {
  const SplinePatch& patch;
  std::array<double, 2> at;

  Beside(const Fits& fits, const EdgeUse& use, double t)
      : patch(fits.patches[use.patch].patch),
        at(place_on_side(
            use.side,
            std::clamp(on_side(fits.topology.patches[use.patch].side[use.side], t), 0.0, 1.0))) {}
  Vec3 normal() const { return patch.at(at[0], at[1]).normal(); }
  double curvature_across(const Vec3& way) const {
    return patch.curvature_across(at[0], at[1], way);
  }
};

bool meets_smoothly(const Topology& topology, std::size_t curve) {
  return curve >= topology.chains.size() || topology.chains[curve].kind == EdgeKind::smooth;
}

// Whether t of a smooth curve is in the tip of a kink of at least this kind, where it has no
// normals.
bool at_kink(const Fits& fits, std::size_t c, double t, Kink least) {
  const Topology& topology = fits.topology;
  if (c >= topology.chains.size()) return false;
  const EdgeChain& chain = topology.chains[c];
  const bool last = t > 0.5;
  const ControlEdge& edge = topology.edges[last ? chain.edges.back() : chain.edges.front()];
  const bool back = last ? chain.reversed.back() : chain.reversed.front();
  if (topology.kinks[edge.sectors[last != back]] < least) return false;
  const FittedCurve& curve = fits.curves[c];
  const auto& at = curve.parameters;
  const auto after = std::upper_bound(at.begin() + 1, at.end() - 1, t);
  const std::size_t k = std::size_t(after - at.begin());
  return curve.normals[k - 1].isZero() || curve.normals[k].isZero();
}

// Calls visit(edge, share along it, t of its curve) at even intervals along all smooth edges of two
// patches, except at kinks that are `unjudged` or sharper.
template <class Visit>
void along_edges(const Fits& fits, const EdgeParts& edges, Kink unjudged, Visit&& visit) {
  fits.workers.for_each(edges.parts.size(), 16, [&](std::size_t e) {
    const EdgePart& part = edges.parts[e];
    if (!meets_smoothly(fits.topology, part.curve) || part.uses.size() != 2) return;
    const int steps = (angles_an_edge - 1) * std::max(1, (part.to - part.from) / 2);
    for (int k = 0; k <= steps; ++k) {
      const double share = double(k) / steps, t = part.on_curve(share);
      if (!at_kink(fits, part.curve, t, unjudged)) visit(e, share, t);
    }
  });
}

double angle_at(const Fits& fits, const EdgePart& part, double t) {
  return angle_between(Beside(fits, part.uses[0], t).normal(),
                       Beside(fits, part.uses[1], t).normal());
}

// Returns the angles without those in the tips of slight kinks, which are the surface's own.
std::vector<double> measure_edges(const Fits& fits, const EdgeParts& edges, SplineSurface& out) {
  out.angles.assign(edges.parts.size() * angles_an_edge, std::numeric_limits<double>::quiet_NaN());
  out.jumps = out.angles;
  std::vector<double> of_patches = out.angles;
  along_edges(fits, edges, Kink::sharp, [&](std::size_t e, double share, double t) {
    const EdgePart& part = edges.parts[e];
    const auto keep = [&](std::vector<double>& in, double value) {
      double& most =
          in[e * angles_an_edge + std::size_t(std::lround(share * (angles_an_edge - 1)))];
      if (!(most >= value)) most = value;
    };
    const Beside a(fits, part.uses[0], t), b(fits, part.uses[1], t);
    const Vec3 way = fits.curves[part.curve].curve.at(t).tangent;
    const double angle = angle_between(a.normal(), b.normal());
    keep(out.angles, angle);
    if (!at_kink(fits, part.curve, t, Kink::slight)) keep(of_patches, angle);
    keep(out.jumps, std::abs(a.curvature_across(way) - b.curvature_across(way)));
  });
  return of_patches;
}

// For each control face. `angles`: of patches, along edges.
void measure_faces(const Fits& fits, const EdgeParts& edges, const std::vector<double>& angles,
                   SplineSurface& out) {
  out.face_off.assign(std::size_t(fits.lattice.faces()), 0.0);
  out.face_angle = out.face_off;
  const Topology& topology = fits.topology;
  const auto raise = [](double& most, double value) { most = std::max(most, value); };
  for (std::size_t p = 0; p < topology.patches.size(); ++p)
    for (std::size_t k = 0; k < topology.patches[p].grid.faces.size(); ++k)
      raise(out.face_off[topology.patches[p].grid.faces[k].face], fits.patches[p].residuals[k]);
  // the faces next to control edge `at` of a curve
  const auto beside = [&](std::size_t c, std::size_t at, auto&& visit) {
    if (c >= topology.chains.size()) return visit((c - topology.chains.size()) / 3);
    const Index edge = topology.chains[c].edges[at];
    for (const SideUse& use : topology.edges[edge].uses) visit(std::size_t(use.face));
  };
  for (std::size_t c = 0; c < fits.curves.size(); ++c) {
    const std::vector<double>& off = fits.curves[c].off;
    const std::size_t count = c < topology.chains.size() ? topology.chains[c].edges.size() : 1,
                      each = (off.size() - 1) / count;
    for (std::size_t k = 0; k < off.size(); ++k)
      beside(c, std::min(k / each, count - 1),
             [&](std::size_t f) { raise(out.face_off[f], off[k]); });
  }
  for (std::size_t e = 0; e < edges.parts.size(); ++e)
    for (std::size_t k = 0; k < angles_an_edge; ++k) {
      const double angle = angles[e * angles_an_edge + k];
      const EdgePart& part = edges.parts[e];
      const double at = part.on_curve(double(k) / (angles_an_edge - 1)) * part.all / 2;
      if (!(angle >= 0)) continue;
      for (const double near : {std::floor(at), std::ceil(at) - 1})  // on both sides of a vertex
        beside(part.curve, std::size_t(std::clamp(near, part.from / 2.0, (part.to - 1) / 2.0)),
               [&](std::size_t f) { raise(out.face_angle[f], angle); });
    }
}

class VertexNumbers {
 public:
  explicit VertexNumbers(std::vector<Vec3>& at) : at_(at) {}
  // Keys are points of the lattice, followed by the centroids of triangles.
  Index of(std::int64_t key, const Vec3& position) {
    const auto [found, is_new] = number_.try_emplace(key, Index(at_.size()));
    if (is_new) at_.push_back(position);
    return found->second;
  }

 private:
  std::vector<Vec3>& at_;
  std::unordered_map<std::int64_t, Index> number_;
};

// The key of a cut of a curve.
std::int64_t vertex_key(const Fits& fits, std::size_t c, int cut) {
  const Lattice& lattice = fits.lattice;
  const int n = lattice.n();
  if (c >= fits.topology.chains.size()) {
    const std::size_t k = c - fits.topology.chains.size();
    if (cut > 0) return std::int64_t(lattice.points() + k / 3);
    return lattice.point(Index(k / 3), int(k % 3), n / 2, 0);
  }
  const EdgeChain& chain = fits.topology.chains[c];
  const std::size_t at = std::min(std::size_t(cut / 2), chain.edges.size() - 1);
  const int along = (cut - 2 * int(at)) * n / 2;
  const SideUse& use = fits.topology.edges[chain.edges[at]].uses.front();
  return lattice.point(use.face, use.side, chain.reversed[at] ? n - along : along, 0);
}

void add_edges(const Fits& fits, const EdgeParts& edges, SplineSurface& out) {
  VertexNumbers vertices(out.vertices);
  for (const std::size_t e : Cancellable(edges.parts.size())) {
    const EdgePart& part = edges.parts[e];
    const FittedCurve& fitted = fits.curves[part.curve];
    SplineCurve curve = part_of(fitted.curve, part.from, part.to, part.all);
    const Index a = vertices.of(vertex_key(fits, part.curve, part.from), curve.points.front()),
                b = vertices.of(vertex_key(fits, part.curve, part.to), curve.points.back());
    curve.points.front() = out.vertices[a];
    curve.points.back() = out.vertices[b];
    const auto point = [&](int cut) {
      return fitted.off.begin() + std::ptrdiff_t(fitted.off.size() - 1) * cut / part.all;
    };
    const double error = *std::max_element(point(part.from), point(part.to) + 1);
    const EdgeKind kind = part.curve < fits.topology.chains.size()
                              ? fits.topology.chains[part.curve].kind
                              : EdgeKind::smooth;
    out.edges.push_back({std::move(curve), kind, {a, b}, error});
  }
}

}  // namespace

void assemble(const Fits& fits, SplineSurface& out) {
  const EdgeParts edges(fits);
  measure_faces(fits, edges, measure_edges(fits, edges, out), out);
  add_edges(fits, edges, out);
  for (const std::size_t p : Cancellable(fits.patches.size())) {
    const PatchPlace& place = fits.topology.patches[p];
    FittedPatch& fitted = fits.patches[p];
    std::vector<LoopEdge> loop;
    for (std::size_t s = 0; s < 4; ++s) {
      PatchSide side = place.side[s];
      if (s >= 2) side.reversed = !side.reversed;  // the loop is opposite to u and v there
      for (const Index e : edges.of(side)) loop.push_back({e, !side.reversed});
    }
    out.loops.push_back(std::move(loop));
    std::vector<Index>& faces = out.faces.emplace_back();
    for (const PlacedFace& placed : place.grid.faces) faces.push_back(placed.face);
    out.residual.push_back(fitted.residual);
    out.turned.push_back(fitted.turned);
    out.patches.push_back(std::move(fitted.patch));
  }
  out.size = fits.lattice.size();
}

std::vector<Directions> patches_to_refine(const Fits& fits, double tolerance) {
  const EdgeParts edges(fits);
  std::vector<double> sharpest(edges.parts.size(), 0.0);
  along_edges(fits, edges, Kink::slight, [&](std::size_t e, double, double t) {
    sharpest[e] = std::max(sharpest[e], angle_at(fits, edges.parts[e], t));
  });
  std::vector<Directions> wanted(fits.patches.size());
  for (const std::size_t e : Cancellable(edges.parts.size())) {
    if (sharpest[e] <= tolerance) continue;
    const std::vector<EdgeUse>& uses = edges.parts[e].uses;
    const auto own = [&](const EdgeUse& use) {
      return fits.patches[use.patch].side_angle[use.side];
    };
    const double larger = std::max(own(uses[0]), own(uses[1]));
    for (const EdgeUse& use : uses)
      if (own(use) >= std::min(larger, tolerance / 2))
        (use.side % 2 ? wanted[use.patch].v : wanted[use.patch].u) = true;
  }
  return wanted;
}

}  // namespace fairing
