// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "splines/assembly.h"
#include "splines/curve_data.h"
#include "splines/patch_data.h"
#include "splines/turns.h"

namespace fairing {
namespace {

// At least four steps of the lattice a span; more spans than these cost more than they gain.
constexpr int steps_a_span = 4, most_spans = 16;
// Where neighbours lean, their normals vary faster beside a vertex than four steps tell.
constexpr int steps_at_edges = 2;
// A patch that leans less at an edge is not taken where inside it turns by more, radians.
constexpr double turned_inside = 0.17;
// Curves and patches take these shares of the tolerance: the refined surface has one, too.
constexpr double curve_share = 0.45, patch_share = 0.45;
// A curve's share where patches lean by more than that share of the angle's tolerance.
constexpr double sharper_share = 0.1, sharp_share = 0.6;
constexpr int angle_rounds = 6;
// Spans along an edge serve where they bring its patch to this share of what it misses.
constexpr double serving = 0.7;
// A lattice that turns by more (radians) between two cells folds itself: so may its patches.
constexpr double hopeless = 0.8;
// Directions whose bending differs by more get spans one after the other.
constexpr double one_sided = 4;

class Fitting {
 public:
  Fitting(const RefinedSurface& surface, const SplineOptions& options, Monitor& monitor)
      : options_(options),
        monitor_(monitor),
        workers_(options.threads),
        lattice_(surface),
        topology_(make_topology(lattice_)),
        curves_(std::size_t(topology_.curves(lattice_))),
        strict_(curves_.size(), 0),
        sharper_(curves_.size(), 0),
        fitted_(topology_.patches.size()),
        settled_(fitted_.size(), 0) {}

  SplineSurface run() {
    SplineSurface out;
    monitor_.report(Phase::patches, 0);
    topology_.kinks = CurveSource(lattice_, topology_).kinks(options_.normal_tolerance);
    out.lattice_turn = lattice_turns(lattice_, topology_, tolerance(), workers_);
    turns_ = out.lattice_turn;
    monitor_.report(Phase::patches, 0.05);
    fit_curves(std::vector<std::uint8_t>(curves_.size(), 1));
    monitor_.report(Phase::patches, 0.3);
    fit_patches();
    monitor_.report(Phase::patches, 0.6);
    unfold();
    monitor_.report(Phase::patches, 0.7);
    refine_at_edges(0.7);
    if (sharpen()) refine_at_edges(0.85);
    out.angles = edge_angles(topology_, fitted_, curves_, workers_);
    assemble(lattice_, topology_, curves_, fitted_, out);
    monitor_.report(Phase::done, 1);
    return out;
  }

 private:
  double tolerance() const { return options_.tolerance * lattice_.size(); }
  // A curve that is off leans as well, and patches cannot mend that either.
  double curve_tolerance(std::size_t c) const {
    constexpr double a_radian = 0.125;
    return (sharper_[c] ? sharper_share : curve_share) * lattice_.size() *
           std::min(options_.tolerance, a_radian * options_.normal_tolerance);
  }
  int most_on(bool part) const {
    return std::clamp(lattice_.n() / (part ? 2 * steps_a_span : steps_a_span), 1, most_spans);
  }

  int most_at_edges(bool part) const {
    return std::clamp(lattice_.n() / (part ? 2 * steps_at_edges : steps_at_edges), 1, most_spans);
  }

  template <class Body>
  void for_each(std::size_t size, Body&& body) {
    workers_.for_parts(size, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) body(k);
    });
  }

  // Those of `which`, by curves.
  void fit_curves(const std::vector<std::uint8_t>& which) {
    const CurveSource source(lattice_, topology_);
    const std::size_t edges = topology_.edges.size();
    const auto limits = [&](std::size_t e) {
      const int least = topology_.edges[e].halved ? 2 : 1;
      return SpanLimits{least, std::max(least, most_on(false)), curve_tolerance(e)};
    };
    const auto fit_kind = [&](bool smooth, auto&& data_of) {
      for_each(edges, [&](std::size_t e) {
        if (!which[e] || (topology_.edges[e].kind == EdgeKind::smooth) != smooth) return;
        CurveData data = data_of(Index(e));
        data.strict = strict_[e];
        curves_[e] = fit_curve(data, limits(e));
      });
    };
    fit_kind(false, [&](Index e) { return source.sharp_edge(e); });
    std::vector<Vec3> normals(topology_.sectors.size(), Vec3::Zero());
    for_each(normals.size(),
             [&](std::size_t s) { normals[s] = source.sector_normal(Index(s), curves_); });
    fit_kind(true, [&](Index e) { return source.smooth_edge(e, normals); });
    for_each(3 * std::size_t(lattice_.triangle_faces()), [&](std::size_t k) {
      const Index f = Index(k / 3);
      const int s = int(k % 3);
      const Index e = topology_.face_edges[std::size_t(f)][std::size_t(s)];
      if (!which[edges + k] && !which[std::size_t(e)]) return;
      CurveData data = source.inner(f, s, curves_[std::size_t(e)]);
      data.strict = strict_[edges + k];
      curves_[edges + k] =
          fit_curve(data, SpanLimits{1, most_on(true), curve_tolerance(edges + k)});
    });
  }

  void fit_patch_to(std::size_t p, int spans_u, int spans_v, bool to_tolerance) {
    const PatchPlace& place = topology_.patches[p];
    PatchData data = patch_data(lattice_, topology_, place, curves_);
    const FaceSurface surface(lattice_, topology_, place.face);
    data.surface = &surface;
    data.corner = place.corner;
    data.tolerance = patch_share * tolerance();
    data.normal_tolerance = options_.normal_tolerance / 2;  // two patches meet
    data.may_fold = turns_[std::size_t(place.face)] > hopeless;
    for (const int s : {0, 2}) spans_u = std::max(spans_u, data.side[std::size_t(s)].spans);
    for (const int s : {1, 3}) spans_v = std::max(spans_v, data.side[std::size_t(s)].spans);
    const int most = std::max({most_on(place.corner >= 0), spans_u, spans_v});
    for (;;) {
      choose_fitted(lattice_, place, std::max(spans_u, spans_v), data);
      const bool grows = to_tolerance && (spans_u < most || spans_v < most);
      FittedPatch next = fit_patch(data, spans_u, spans_v, !grows);
      const bool turns_more =
          !to_tolerance && next.turned > std::max(turned_inside, fitted_[p].turned);
      if (fitted_[p].patch.net.empty() || (next.misses < fitted_[p].misses && !turns_more))
        fitted_[p] = std::move(next);
      if (!to_tolerance || (fitted_[p].residual <= data.tolerance && !fitted_[p].folds())) return;
      const double more = bends_more_along_u(fitted_[p].patch);
      const bool grow_u = spans_u < most && (more > 1 / one_sided || spans_v >= most),
                 grow_v = spans_v < most && (more < one_sided || spans_u >= most);
      if (!grow_u && !grow_v) return;
      spans_u *= grow_u ? 2 : 1;
      spans_v *= grow_v ? 2 : 1;
    }
  }

  void fit_patches() {
    for_each(fitted_.size(), [&](std::size_t p) { fit_patch_to(p, 1, 1, true); });
  }

  // Where curves that leave the lattice's lines make patches fold, as in narrow corners, they are
  // fitted to these.
  void unfold() {
    std::vector<std::uint8_t> which(curves_.size(), 0);
    for (std::size_t p = 0; p < fitted_.size(); ++p)
      if (fitted_[p].folds() && turns_[std::size_t(topology_.patches[p].face)] <= hopeless)
        for (const PatchSide& side : topology_.patches[p].side)
          which[std::size_t(side.curve)] = strict_[std::size_t(side.curve)] = 1;
    fit_again(which);
  }

  // Where neighbours still meet at too sharp an angle, their curve may be too coarse for them.
  bool sharpen() {
    std::vector<std::uint8_t> which(curves_.size(), 0);
    for (std::size_t p = 0; p < fitted_.size(); ++p)
      for (std::size_t s = 0; s < 4; ++s)
        if (fitted_[p].side_angle[s] > sharp_share * options_.normal_tolerance) {
          const std::size_t c = std::size_t(topology_.patches[p].side[s].curve);
          which[c] = sharper_[c] = 1;
        }
    return fit_again(which);
  }

  // Those curves, and the patches on both sides.
  bool fit_again(std::vector<std::uint8_t>& which) {
    if (std::find(which.begin(), which.end(), 1) == which.end()) return false;
    fit_curves(which);
    for (std::size_t k = 0; k < 3 * std::size_t(lattice_.triangle_faces()); ++k)
      if (which[std::size_t(topology_.face_edges[k / 3][k % 3])])
        which[topology_.edges.size() + k] = 1;
    for_each(fitted_.size(), [&](std::size_t p) {
      const auto& sides = topology_.patches[p].side;
      if (std::none_of(sides.begin(), sides.end(),
                       [&](const PatchSide& side) { return which[std::size_t(side.curve)]; }))
        return;
      fitted_[p] = {};
      settled_[p] = 0;
      fit_patch_to(p, 1, 1, true);
    });
    return true;
  }

  void refine_at_edges(double done) {
    for (int round = 0; round < angle_rounds && add_spans_at_edges(); ++round)
      monitor_.report(Phase::patches, done + 0.1 * (round + 1) / angle_rounds);
  }

  // More spans where neighbours meet at too sharp an angle, along their edge if that serves; false
  // where nothing changed.
  bool add_spans_at_edges() {
    const std::vector<Directions> wanted =
        patches_to_refine(topology_, fitted_, curves_, options_.normal_tolerance, workers_);
    std::vector<std::uint8_t> changed(fitted_.size(), 0);
    for_each(fitted_.size(), [&](std::size_t p) {
      if (!wanted[p].any() || settled_[p]) return;
      const int most = most_at_edges(topology_.patches[p].corner >= 0);
      const int spans_u = fitted_[p].patch.spans_u, spans_v = fitted_[p].patch.spans_v;
      const double before = fitted_[p].misses;
      const int more_u = std::max(spans_u, std::min(most, 2 * spans_u)),
                more_v = std::max(spans_v, std::min(most, 2 * spans_v));
      const int u = wanted[p].u ? more_u : spans_u, v = wanted[p].v ? more_v : spans_v;
      if (u != spans_u || v != spans_v) fit_patch_to(p, u, v, false);
      if (fitted_[p].misses > serving * before && (u != more_u || v != more_v))
        fit_patch_to(p, more_u, more_v, false);
      changed[p] = fitted_[p].misses < before;
      settled_[p] = !changed[p];
    });
    return std::find(changed.begin(), changed.end(), 1) != changed.end();
  }

  SplineOptions options_;
  Monitor& monitor_;
  Workers workers_;
  Lattice lattice_;
  Topology topology_;
  std::vector<FittedCurve> curves_;
  std::vector<std::uint8_t> strict_, sharper_;  // curves
  std::vector<FittedPatch> fitted_;
  std::vector<std::uint8_t> settled_;  // patches that more spans do not serve
  std::vector<double> turns_;
};

}  // namespace

SplineSurface fit_splines(const RefinedSurface& surface, const SplineOptions& options,
                          Monitor& monitor) {
  const CancelScope scope(&monitor);
  if (!(options.tolerance > 0) || !(options.normal_tolerance > 0))
    throw FairingError(ErrorCode::bad_option,
                       "tolerance and normal_tolerance must be greater than 0.");
  return Fitting(surface, options, monitor).run();
}

}  // namespace fairing
