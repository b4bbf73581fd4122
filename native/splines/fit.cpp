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
// Curves and patches take these shares of the tolerance: the refined surface has one, too, and
// patches cannot mend their curves.
constexpr double curve_share = 0.3, patch_share = 0.45;
constexpr int angle_rounds = 4;
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
        fitted_(topology_.patches.size()) {}

  SplineSurface run() {
    SplineSurface out;
    monitor_.report(Phase::patches, 0);
    out.lattice_turn = lattice_turns(lattice_, topology_, workers_);
    turns_ = out.lattice_turn;
    monitor_.report(Phase::patches, 0.05);
    fit_curves();
    monitor_.report(Phase::patches, 0.3);
    fit_patches();
    monitor_.report(Phase::patches, 0.7);
    for (int round = 0; round < angle_rounds && refine_at_edges(); ++round)
      monitor_.report(Phase::patches, 0.7 + 0.2 * (round + 1) / angle_rounds);
    out.angles = edge_angles(topology_, fitted_, curves_.size(), workers_);
    assemble(lattice_, topology_, curves_, fitted_, out);
    monitor_.report(Phase::done, 1);
    return out;
  }

 private:
  double tolerance() const { return options_.tolerance * lattice_.size(); }
  // A curve that is off leans as well, and patches cannot mend that either.
  double curve_tolerance() const {
    constexpr double a_radian = 0.125;
    return curve_share * lattice_.size() *
           std::min(options_.tolerance, a_radian * options_.normal_tolerance);
  }
  int most_on(bool part) const {
    return std::clamp(lattice_.n() / (part ? 2 * steps_a_span : steps_a_span), 1, most_spans);
  }

  template <class Body>
  void for_each(std::size_t size, Body&& body) {
    workers_.for_parts(size, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) body(k);
    });
  }

  void fit_curves() {
    const CurveSource source(lattice_, topology_);
    const std::size_t edges = topology_.edges.size();
    const auto limits = [&](std::size_t e) {
      const int least = topology_.edges[e].halved ? 2 : 1;
      return SpanLimits{least, std::max(least, most_on(false)), curve_tolerance()};
    };
    for_each(edges, [&](std::size_t e) {
      if (topology_.edges[e].kind != EdgeKind::smooth)
        curves_[e] = fit_curve(source.sharp_edge(Index(e)), limits(e));
    });
    std::vector<Vec3> normals(topology_.sectors.size(), Vec3::Zero());
    for_each(normals.size(),
             [&](std::size_t s) { normals[s] = source.sector_normal(Index(s), curves_); });
    for_each(edges, [&](std::size_t e) {
      if (topology_.edges[e].kind == EdgeKind::smooth)
        curves_[e] = fit_curve(source.smooth_edge(Index(e), normals), limits(e));
    });
    const SpanLimits inside{1, most_on(true), curve_tolerance()};
    for_each(3 * std::size_t(lattice_.triangle_faces()), [&](std::size_t k) {
      const Index f = Index(k / 3);
      const int s = int(k % 3);
      const Index e = topology_.face_edges[std::size_t(f)][std::size_t(s)];
      curves_[edges + k] = fit_curve(source.inner(f, s, curves_[std::size_t(e)]), inside);
    });
  }

  void fit_patch_to(std::size_t p, int spans_u, int spans_v, bool to_tolerance) {
    const PatchPlace& place = topology_.patches[p];
    PatchData data = patch_data(lattice_, place, curves_);
    data.tolerance = patch_share * tolerance();
    data.normal_tolerance = options_.normal_tolerance / 2;  // two patches meet
    data.may_fold = turns_[std::size_t(place.face)] > hopeless;
    for (const int s : {0, 2}) spans_u = std::max(spans_u, data.side[std::size_t(s)].spans);
    for (const int s : {1, 3}) spans_v = std::max(spans_v, data.side[std::size_t(s)].spans);
    const int most = std::max({most_on(place.corner >= 0), spans_u, spans_v});
    for (;;) {
      choose_fitted(lattice_, place, std::max(spans_u, spans_v), data);
      FittedPatch next = fit_patch(data, spans_u, spans_v);
      if (fitted_[p].patch.net.empty() || next.misses < fitted_[p].misses)
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

  // More spans where neighbours meet at too sharp an angle; false where nothing changed.
  bool refine_at_edges() {
    const std::vector<std::uint8_t> wanted =
        patches_to_refine(topology_, fitted_, curves_.size(), options_.normal_tolerance, workers_);
    std::vector<std::uint8_t> changed(fitted_.size(), 0);
    for_each(fitted_.size(), [&](std::size_t p) {
      if (!wanted[p]) return;
      const int most = most_on(topology_.patches[p].corner >= 0);
      const SplinePatch& before = fitted_[p].patch;
      const int u = std::max(before.spans_u, std::min(most, 2 * before.spans_u)),
                v = std::max(before.spans_v, std::min(most, 2 * before.spans_v));
      changed[p] = u != before.spans_u || v != before.spans_v;
      if (changed[p]) fit_patch_to(p, u, v, false);
    });
    return std::find(changed.begin(), changed.end(), 1) != changed.end();
  }

  SplineOptions options_;
  Monitor& monitor_;
  Workers workers_;
  Lattice lattice_;
  Topology topology_;
  std::vector<FittedCurve> curves_;
  std::vector<FittedPatch> fitted_;
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
