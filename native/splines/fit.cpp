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
    monitor_.report(Phase::patches, 0.125);
    fit_curves(std::vector<std::uint8_t>(curves_.size(), 1));
    monitor_.report(Phase::patches, 0.25);
    fit_patches();
    monitor_.report(Phase::patches, 0.625);
    unfold();
    refine_at_edges(0.75);
    if (sharpen()) refine_at_edges(0.875);
    out.angles = edge_angles(topology_, fitted_, curves_, workers_);
    assemble(lattice_, topology_, curves_, fitted_, out);
    monitor_.report(Phase::done, 1);
    return out;
  }

 private:
  double tolerance() const { return options_.tolerance * lattice_.size(); }
  // The refined surface has the other half. A curve that is off leans as well, and patches cannot mend
  // that either: it counts more where they lean.
  double curve_tolerance(std::size_t c) const {
    return lattice_.size() * std::min(options_.tolerance, options_.normal_tolerance / 8) /
           (sharper_[c] ? 8 : 2);
  }
  // On all of a face's side, or on a third's; of so many steps a span.
  int most_on(bool part, int steps = steps_a_span) const {
    return std::clamp(lattice_.n() / (part ? 2 * steps : steps), 1, most_spans);
  }
  // Where neighbours lean, their normals vary faster beside a vertex than a span's steps tell.
  int most_at_edges(bool part) const { return most_on(part, steps_a_span / 2); }

  template <class Body>
  void for_each(std::size_t size, Body&& body) {
    workers_.for_parts(size, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) body(k);
    });
  }

  void hold_to_line(CurveData& data, std::size_t curve) const {
    data.strict = strict_[curve] > 0;
    data.own = strict_[curve] > 1;
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
        hold_to_line(data, e);
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
      hold_to_line(data, edges + k);
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
    data.tolerance = tolerance() / 2;
    data.normal_tolerance = options_.normal_tolerance / 2;  // two patches meet
    data.may_fold = turns_[std::size_t(place.face)] > folded;
    for (const int s : {0, 2}) spans_u = std::max(spans_u, data.side[std::size_t(s)].spans);
    for (const int s : {1, 3}) spans_v = std::max(spans_v, data.side[std::size_t(s)].spans);
    const int most = std::max({most_on(place.corner >= 0), spans_u, spans_v});
    for (;;) {
      choose_fitted(lattice_, place, std::max(spans_u, spans_v), data);
      const bool grows = to_tolerance && (spans_u < most || spans_v < most);
      FittedPatch next = fit_patch(data, spans_u, spans_v, !grows);
      // one that leans less at an edge, and turns by more inside, swings between its samples
      const bool swings = !to_tolerance && next.turned > std::max(folded / 4, fitted_[p].turned);
      if (fitted_[p].patch.net.empty() || (next.misses < fitted_[p].misses && !swings))
        fitted_[p] = std::move(next);
      if (!grows || (fitted_[p].residual <= data.tolerance && !fitted_[p].misses.folds)) return;
      spans_u *= spans_u < most ? 2 : 1;
      spans_v *= spans_v < most ? 2 : 1;
    }
  }

  void fit_patches() {
    for_each(fitted_.size(), [&](std::size_t p) { fit_patch_to(p, 1, 1, true); });
  }

  // Where curves that leave the lattice's lines make patches fold, as in narrow corners, they are
  // fitted to these; and where that does not help, as on faces a hundred times as long as wide, at
  // the lattice's own parameters, with the patches.
  void unfold() {
    for (const std::uint8_t strict : {1, 2}) {
      std::vector<std::uint8_t> which(curves_.size(), 0);
      for (std::size_t p = 0; p < fitted_.size(); ++p)
        if (fitted_[p].misses.folds && turns_[std::size_t(topology_.patches[p].face)] <= folded)
          for (const PatchSide& side : topology_.patches[p].side) {
            which[std::size_t(side.curve)] = 1;
            strict_[std::size_t(side.curve)] = strict;
          }
      fit_again(which);
    }
  }

  // Where neighbours still meet at too sharp an angle, their curve may be too coarse for them.
  bool sharpen() {
    std::vector<std::uint8_t> which(curves_.size(), 0);
    for (std::size_t p = 0; p < fitted_.size(); ++p)
      for (std::size_t s = 0; s < 4; ++s)
        if (fitted_[p].side_angle[s] > options_.normal_tolerance / 2) {
          const std::size_t c = std::size_t(topology_.patches[p].side[s].curve);
          which[c] = sharper_[c] = 1;
        }
    std::vector<std::uint8_t> folds;
    for (const FittedPatch& patch : fitted_) folds.push_back(patch.misses.folds);
    if (!fit_again(which)) return false;
    blunt_where_new(folds);
    return true;
  }

  // Curves that have become sharper are as before around patches that fold now, and did not.
  void blunt_where_new(const std::vector<std::uint8_t>& folded_before) {
    std::vector<std::uint8_t> which(curves_.size(), 0);
    const auto blunt = [&](Index curve) {
      const auto c = std::size_t(curve);
      if (sharper_[c]) which[c] = 1, sharper_[c] = 0;
    };
    for (std::size_t p = 0; p < fitted_.size(); ++p) {
      if (!fitted_[p].misses.folds || folded_before[p]) continue;
      const PatchPlace& place = topology_.patches[p];
      for (const PatchSide& side : place.side) blunt(side.curve);
      if (place.corner >= 0)  // the other curves of a triangle follow its sides
        for (std::size_t s = 0; s < 3; ++s) blunt(topology_.face_edges[std::size_t(place.face)][s]);
    }
    fit_again(which);
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

  // Ends: a patch has no more than `most_spans` each way, and is tried once with each number.
  void refine_at_edges(double done) {
    do monitor_.report(Phase::patches, done);
    while (add_spans_at_edges());
  }

  // More spans where neighbours meet at too sharp an angle, along their edge if that halves what
  // they miss, or both ways; false where nothing changed.
  bool add_spans_at_edges() {
    const std::vector<Directions> wanted =
        patches_to_refine(topology_, fitted_, curves_, options_.normal_tolerance, workers_);
    std::vector<std::uint8_t> changed(fitted_.size(), 0);
    for_each(fitted_.size(), [&](std::size_t p) {
      if (!wanted[p].any() || settled_[p]) return;
      const int most = most_at_edges(topology_.patches[p].corner >= 0);
      const int spans_u = fitted_[p].patch.spans_u, spans_v = fitted_[p].patch.spans_v;
      const Misses before = fitted_[p].misses;
      const int more_u = std::max(spans_u, std::min(most, 2 * spans_u)),
                more_v = std::max(spans_v, std::min(most, 2 * spans_v));
      const int u = wanted[p].u ? more_u : spans_u, v = wanted[p].v ? more_v : spans_v;
      if (u != spans_u || v != spans_v) fit_patch_to(p, u, v, false);
      if (fitted_[p].misses > Misses{before.folds, before.by / 2} && (u != more_u || v != more_v))
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
  std::vector<std::uint8_t> strict_, sharper_;  // curves; 2: at the lattice's own parameters
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
