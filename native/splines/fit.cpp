// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "splines/assembly.h"
#include "splines/chains.h"
#include "splines/curve_data.h"
#include "splines/kept.h"
#include "splines/patch_data.h"
#include "splines/turns.h"

namespace fairing {
namespace {

bool any(const std::vector<std::uint8_t>& flags) { return std::ranges::count(flags, 1) > 0; }

class Fitting {
 public:
  Fitting(const RefinedSurface& surface, const SplineOptions& options, Monitor& monitor)
      : options_(options),
        monitor_(monitor),
        workers_(options.threads),
        lattice_(surface),
        topology_(make_topology(lattice_)) {}

  SplineSurface run() {
    SplineSurface out;
    monitor_.report(Phase::patches, 0);
    topology_.kinks = CurveSource(lattice_, topology_, options_.normal_tolerance)
                          .kinks(options_.normal_tolerance);
    out.lattice_turn = lattice_turns(lattice_, topology_, tolerance(), workers_);
    turns_ = out.lattice_turn;
    const Walls walls = find_walls(lattice_, topology_, options_.groups, options_.normal_tolerance);
    std::vector<FaceGrid> grids = lay_out(lattice_, topology_, walls);
    do {
      do {
        const Topology before = topology_;
        make_patches(lattice_, walls, grids, topology_);
        take_over(before);
        fit_new();
      } while (split(grids, [&](const FittedPatch& patch) { return is_far_off(patch); }));
      meet_neighbours();  // only once no grid is far off, since those are cut anyway
    } while (split(grids, misses_much));
    assemble({lattice_, topology_, curves_, fitted_, workers_}, out);
    monitor_.report(Phase::done, 1);
    return out;
  }

 private:
  // Curves and patches that are as they were before some grids became two are not fitted again.
  void take_over(const Topology& before) {
    const Kept kept = kept_from(lattice_, before, topology_);
    take(kept.curves, curves_);
    take(kept.curves, strict_);
    take(kept.curves, sharper_);
    take(kept.patches, fitted_);
    take(kept.patches, settled_);
    new_curves_ = are_new(kept.curves);
    new_patches_ = are_new(kept.patches);
    take(kept.patches, unmet_);
    for (std::size_t p = 0; p < unmet_.size(); ++p) unmet_[p] |= new_patches_[p];
  }

  template <class T>
  static void take(const std::vector<Index>& from, std::vector<T>& all) {
    auto old = std::exchange(all, std::vector<T>(from.size()));
    for (std::size_t k = 0; k < from.size(); ++k)
      if (from[k] >= 0) all[k] = std::move(old[from[k]]);
  }

  static std::vector<std::uint8_t> are_new(const std::vector<Index>& from) {
    std::vector<std::uint8_t> out;
    for (const Index old : from) out.push_back(old < 0);
    return out;
  }

  void fit_new() {
    fit_curves(new_curves_);
    monitor_.report(Phase::patches, 0.25);
    fit_patches(new_patches_);
    monitor_.report(Phase::patches, 0.625);
    unfold();
  }

  void meet_neighbours() {
    refine_at_edges(false);  // patches that miss have their curves sharpened and are fitted again
    if (sharpen()) refine_at_edges(true);
    unmet_.assign(unmet_.size(), 0);
  }

  bool is_far_off(const FittedPatch& patch) const {
    return patch.misses.folds || patch.residual > tolerance();
  }
  static bool misses_much(const FittedPatch& patch) { return patch.misses > Misses{false, 2}; }

  // Cuts the grids of several faces whose patch is `bad` in two; those at folds of the lattice,
  // which no patch can follow, into single faces. False if there are none.
  template <class Test>
  bool split(std::vector<FaceGrid>& grids, const Test& bad) {
    const std::size_t thirds = fitted_.size() - grids.size(), count = grids.size();
    for (std::size_t g = 0; g < count; ++g) {
      if (grids[g].faces.size() == 1 || !bad(fitted_[thirds + g])) continue;
      const FaceGrid whole = std::move(grids[g]);
      if (turns_sharply(topology_.patches[thirds + g])) {
        grids[g] = {1, 1, {whole.faces[0]}};
        for (std::size_t k = 1; k < whole.faces.size(); ++k)
          grids.push_back({1, 1, {whole.faces[k]}});
      } else {
        auto [first, second] = halves_of(whole);
        grids[g] = std::move(first);
        grids.push_back(std::move(second));
      }
    }
    return grids.size() > count;
  }

  double tolerance() const { return options_.tolerance * lattice_.size(); }
  // A curve may use half of the tolerance; the refined surface's own error may use the other half. A
  // curve with an error also has wrong normals, which patches cannot correct, so a curve at which
  // neighbours meet at too large an angle (sharper_) has a smaller tolerance.
  double curve_tolerance(std::size_t c) const {
    return lattice_.size() * std::min(options_.tolerance, options_.normal_tolerance / 8) /
           (sharper_[c] ? 8 : 2);
  }
  template <class Body>
  void for_each(std::size_t size, Body&& body) {
    workers_.for_each(size, 1, [&](std::size_t k) { body(k); });
  }

  void hold_to_line(CurveData& data, std::size_t curve) const {
    data.strict = strict_[curve] > 0;
    data.own = strict_[curve] > 1;
  }

  // The flagged curves.
  void fit_curves(const std::vector<std::uint8_t>& which) {
    const CurveSource source(lattice_, topology_, options_.normal_tolerance);
    const std::size_t chains = topology_.chains.size();
    const auto limits = [&](std::size_t c) {
      const EdgeChain& chain = topology_.chains[c];
      const int least = chain.least_spans();
      return SpanLimits{least, std::max(least, most_spans_on(lattice_, int(chain.edges.size()))),
                        curve_tolerance(c)};
    };
    const auto fit_kind = [&](bool smooth, auto&& data_of) {
      for_each(chains, [&](std::size_t c) {
        if (!which[c] || (topology_.chains[c].kind == EdgeKind::smooth) != smooth) return;
        CurveData data = data_of(Index(c));
        hold_to_line(data, c);
        curves_[c] = fit_curve(data, limits(c));
      });
    };
    fit_kind(false, [&](Index c) { return source.sharp_chain(c); });
    std::vector<Vec3> normals(topology_.sectors.size(), Vec3::Zero());
    for_each(normals.size(),
             [&](std::size_t s) { normals[s] = source.sector_normal(Index(s), curves_); });
    fit_kind(true, [&](Index c) { return source.smooth_chain(c, normals); });
    for_each(3 * std::size_t(lattice_.triangle_faces()), [&](std::size_t k) {
      const Index f = Index(k / 3);
      const int s = int(k % 3);
      if (!which[chains + k] && !which[topology_.chain_of({f, s})]) return;
      CurveData data = source.inner(f, s, curves_);
      hold_to_line(data, chains + k);
      curves_[chains + k] = fit_curve(
          data, SpanLimits{1, most_spans_on(lattice_, 1, true), curve_tolerance(chains + k)});
    });
  }

  void fit_patch_to(std::size_t p, int spans_u, int spans_v, bool to_tolerance,
                    bool all_ways = true) {
    const PatchPlace& place = topology_.patches[p];
    PatchData data = patch_data(lattice_, topology_, place, curves_);
    const FaceSurface surface(Sheet(lattice_, place.grid), topology_);
    data.surface = &surface;
    data.faces = place.grid.faces.size();
    data.corner = place.corner;
    data.tolerance = tolerance() / 2;
    data.normal_tolerance = options_.normal_tolerance / 2;  // two patches meet
    // several are cut in two, and before curves are sharper only what does not fold is wanted
    data.may_fold =
        place.several() || turns_sharply(place) || (!all_ways && !fitted_[p].misses.folds);
    for (const int s : {0, 2}) spans_u = std::max(spans_u, data.side[s].spans);
    for (const int s : {1, 3}) spans_v = std::max(spans_v, data.side[s].spans);
    const int most_u = std::max(place.most_spans(lattice_, place.grid.columns), spans_u),
              most_v = std::max(place.most_spans(lattice_, place.grid.rows), spans_v);
    const auto fit = [&](int u, int v, bool last) {
      choose_fitted(lattice_, place, u, v, data);
      FittedPatch next = fit_patch(data, u, v, last && all_ways && !place.several());
      // a patch that meets its neighbours better, but turns by more inside, oscillates between its
      // samples
      const bool swings = !to_tolerance && next.turned > std::max(folded / 4, fitted_[p].turned);
      if (fitted_[p].patch.net.empty() || (next.misses < fitted_[p].misses && !swings))
        fitted_[p] = std::move(next);
      return fitted_[p].residual <= data.tolerance && !fitted_[p].misses.folds;
    };
    for (;;) {
      const int more_u = spans_u < most_u ? 2 * spans_u : spans_u,
                more_v = spans_v < most_v ? 2 * spans_v : spans_v;
      const bool grows = to_tolerance && (more_u > spans_u || more_v > spans_v);
      if (fit(spans_u, spans_v, !grows) || !grows) return;
      // for a patch of several faces more spans in one direction may suffice
      if (place.several() && more_u > spans_u && more_v > spans_v &&
          (fit(spans_u, more_v, false) || fit(more_u, spans_v, false)))
        return;
      spans_u = more_u;
      spans_v = more_v;
    }
  }

  bool turns_sharply(const PatchPlace& place) const {
    return std::ranges::any_of(place.grid.faces,
                               [&](const PlacedFace& face) { return turns_[face.face] > folded; });
  }

  // The flagged patches.
  void fit_patches(const std::vector<std::uint8_t>& which) {
    for_each(fitted_.size(), [&](std::size_t p) {
      if (!which[p]) return;
      fitted_[p] = {};
      settled_[p] = 0;
      fit_patch_to(p, topology_.patches[p].grid.columns, topology_.patches[p].grid.rows, true);
    });
  }

  // If curves that leave the lattice's lines make patches fold, as in narrow corners, they are
  // fitted to these lines; if that does not help, as on faces a hundred times as long as wide, they
  // get the lattice's parameters, and the patches too.
  void unfold() {
    for (const std::uint8_t strict : {1, 2}) {
      std::vector<std::uint8_t> which(curves_.size(), 0);
      for (std::size_t p = 0; p < fitted_.size(); ++p)
        if (const PatchPlace& place = topology_.patches[p];
            fitted_[p].misses.folds && !place.several() && !turns_sharply(place))
          for (const PatchSide& side : place.side)
            if (std::uint8_t& own = strict_[side.curve]; own < strict) {
              which[side.curve] = 1;
              own = strict;
            }
      fit_again(which);
    }
  }

  // If neighbours still meet at too large an angle, their curve may be too coarse.
  bool sharpen() {
    std::vector<std::uint8_t> which(curves_.size(), 0);
    for (std::size_t p = 0; p < fitted_.size(); ++p)
      for (std::size_t s = 0; s < 4; ++s)
        if (unmet_[p] && fitted_[p].side_angle[s] > options_.normal_tolerance / 2) {
          const std::size_t c = std::size_t(topology_.patches[p].side[s].curve);
          which[c] = sharper_[c] = 1;
        }
    std::vector<std::uint8_t> folds;
    for (const FittedPatch& patch : fitted_) folds.push_back(patch.misses.folds);
    if (!fit_again(which)) return false;
    blunt_where_new(folds);
    return true;
  }

  // Restores curves that were refined around patches that fold now and did not before.
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
        for (int s = 0; s < 3; ++s) blunt(topology_.chain_of({place.grid.faces[0].face, s}));
    }
    fit_again(which);
  }

  // Fits the flagged curves again, and the patches on both sides.
  bool fit_again(std::vector<std::uint8_t>& which) {
    if (!any(which)) return false;
    fit_curves(which);
    for (std::size_t k = 0; k < 3 * std::size_t(lattice_.triangle_faces()); ++k)
      if (which[topology_.chain_of({Index(k / 3), int(k % 3)})])
        which[topology_.chains.size() + k] = 1;
    std::vector<std::uint8_t> beside;
    for (const PatchPlace& place : topology_.patches)
      beside.push_back(std::ranges::any_of(
          place.side, [&](const PatchSide& side) { return which[side.curve]; }));
    fit_patches(beside);
    return true;
  }

  // Ends, since a patch has at most `most_spans` in each direction, and each number is tried once.
  void refine_at_edges(bool all_ways) {
    while (add_spans_at_edges(all_ways)) stop_if_cancelled();
  }

  // Adds spans where neighbours meet at too large an angle: along their edge if that halves the
  // error, otherwise in both directions. False if nothing changed.
  bool add_spans_at_edges(bool all_ways) {
    const std::vector<Directions> wanted = patches_to_refine(
        {lattice_, topology_, curves_, fitted_, workers_}, options_.normal_tolerance);
    std::vector<std::uint8_t> changed(fitted_.size(), 0);
    for_each(fitted_.size(), [&](std::size_t p) {
      if (!wanted[p].any() || settled_[p]) return;
      const PatchPlace& place = topology_.patches[p];
      const int spans_u = fitted_[p].patch.spans_u, spans_v = fitted_[p].patch.spans_v;
      const Misses before = fitted_[p].misses;
      const auto more = [&](int spans, int faces) {
        // where neighbours lean, normals vary faster beside a vertex than a span's steps tell
        return (2 * spans <= place.most_spans(lattice_, faces, steps_a_span / 2) ? 2 : 1) * spans;
      };
      const int more_u = more(spans_u, place.grid.columns), more_v = more(spans_v, place.grid.rows);
      const int u = wanted[p].u ? more_u : spans_u, v = wanted[p].v ? more_v : spans_v;
      if (u != spans_u || v != spans_v) fit_patch_to(p, u, v, false, all_ways);
      if (fitted_[p].misses > Misses{before.folds, before.by / 2} && (u != more_u || v != more_v))
        fit_patch_to(p, more_u, more_v, false, all_ways);
      changed[p] = fitted_[p].misses < before;
      settled_[p] = !changed[p];
    });
    return any(changed);
  }

  SplineOptions options_;
  Monitor& monitor_;
  Workers workers_;
  Lattice lattice_;
  Topology topology_;
  std::vector<FittedCurve> curves_;
  std::vector<std::uint8_t> strict_, sharper_;  // by curve; 2: the lattice's parameters
  std::vector<FittedPatch> fitted_;
  std::vector<std::uint8_t> settled_;                   // patches that more spans do not serve
  std::vector<std::uint8_t> new_curves_, new_patches_;  // that no earlier round has fitted
  std::vector<std::uint8_t> unmet_;  // patches that have not met their neighbours in any round
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
