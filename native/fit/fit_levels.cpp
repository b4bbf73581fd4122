// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/fit_levels.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "curvature/area.h"
#include "fit/measure.h"
#include "fit/round_off.h"
#include "grid/linear.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// The level on which the weight is chosen: the waves that matter are longer than its edges. Coarse
// control meshes with many points a face use a finer level.
constexpr int level_of_search = 2;

// Every `step`-th point.
Scan thinned(const Scan& scan, std::size_t step) {
  Scan out;
  for (std::size_t s = 0; s < scan.size(); s += step) {
    out.point.push_back(scan.point[s]);
    out.given.push_back(scan.given[s]);
    if (!scan.normal.empty()) out.normal.push_back(scan.normal[s]);
  }
  return out;
}

int search_level(const ControlMesh& mesh, int top, std::size_t points) {
  int level = std::min(level_of_search, top);
  std::size_t halves = 0;  // two triangles have as many points as a quad
  for (const Face& face : mesh.faces) halves += face.quad() ? 2 : 1;
  const auto cells = [&](int l) { return halves << (2 * l) >> 1; };
  while (level < top && cells(level + 1) <= cells_of_search &&
         double(points) >= points_a_blob * double(cells(level + 1)))
    ++level;
  return level;
}

bool has_ends(const ControlMesh& mesh) {
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    if (mesh.feature_edge[e] || mesh.edges[e].boundary()) return true;
  return false;
}

double area_of(const GridLevel& grid, Workers& workers, const std::vector<Vec3>& control) {
  Array<double> x(3 * grid.size());
  refine_linearly(grid, control, workers, x.data());
  return surface_area(grid, workers, x.data());
}

}  // namespace

FitLevels::FitLevels(const FairingProblem& problem, ThinPlateLevels& levels, const Scan& scan,
                     const FitSettings& settings, Monitor& monitor)
    : problem_(problem),
      levels_(levels),
      scan_(scan),
      settings_(settings),
      monitor_(monitor),
      control_(problem.basis),
      curves_(problem, scan, settings.fixed),
      search_(search_level(problem.mesh, levels.top(), scan.size())),
      thin_(thinned(scan, (scan.size() + enough_points - 1) / enough_points)),
      unit_(stiffness_of_wave / std::pow(problem.units.edge * problem.units.edge_in_space, 2)),
      area_(area_of(levels.grid(search_), levels.workers(), control_.working)) {}

void FitLevels::run(FitReport& report) {
  const FitProblem rough = problem_of(thin_);
  auto fit = std::make_unique<LevelFit>(rough, search_);
  begin(*fit);
  WeightChoice choice(*fit, settings_, problem_.frame.scale, has_ends(problem_.mesh));
  weight_ = choice.choose(monitor_, !curves_.any());
  is_kept_ = choice.is_by_tolerance();
  const bool is_automatic = !(settings_.weight > 0) && !is_kept_;
  if (is_automatic && curves_.any()) {
    // so far the curves were those of weight 1, which follow the noise
    fit_curves(*fit, weight_, 2, true);
    weight_ = choice.choose(monitor_, true);
  }
  report.trials = choice.trials();
  weight_ *= choice.more_points(thin_.size());
  const FitProblem whole = problem_of(scan_);
  // The decrease of the residual from level to level is not noise but the resolution of the
  // level. Such shapes need the shorter waves of the next level, so the weight grows with them.
  double left_below = 0;
  for (int level = search_; level <= levels_.top(); ++level) {
    const bool is_last = level == levels_.top();
    Array<double> x = level == search_ ? fit->surface() : above(*fit);
    report.iterations += fit->iterations();
    // coarser levels are only a start, so they use fewer points
    fit = std::make_unique<LevelFit>(is_last ? whole : rough, level);
    if (is_last) weight_ *= choice.more_points(scan_.size()) / choice.more_points(thin_.size());
    fit->set_surface(std::move(x));
    fit->stay_near(prior(*fit));
    fit_curves(*fit, weight_, 2, true);
    const double left = spread_of(fit->feet(), {}).rms;
    if (is_automatic && level > search_) {
      const double grown = weight_ * std::pow(std::max(left_below / left, 1.0), 2);
      weight_ = std::max(weight_, std::min(grown, fit->stiffest()));
    }
    left_below = left;
    fit_curves(*fit, weight_, 2, true);
    monitor_.report(Phase::solve, 1 - std::pow(2, level - levels_.top() - 3));
  }
  keep_tolerance(*fit);
  round_off(*fit, weight_);
  report.iterations += fit->iterations();
  report.weight = weight_;
  surface_ = fit->surface();
  measure_fit(*fit, problem_, report);
}

FitProblem FitLevels::problem_of(const Scan& scan) const {
  return {levels_,
          scan,
          unit_,
          area_,
          problem_.units.edge_in_space,
          problem_.options.solve.max_iterations,
          monitor_};
}

// Moves a smooth surface from the control polyhedron to the scan: distant feet carry no detail.
void FitLevels::begin(LevelFit& fit) {
  const GridLevel& grid = levels_.grid(search_);
  Array<double> x(3 * grid.size());
  refine_linearly(grid, control_.working, levels_.workers(), x.data());
  levels_.put_fixed(search_, data(), x.data());
  fit.set_surface(std::move(x));
  require_match(fit);
  fit.stay_near(prior(fit));
  fit_curves(fit, 1, 3, false);
  fit.stay_near(prior(fit));
}

// Throws if most points are on the surface's other side, or hardly any has a foot.
void FitLevels::require_match(const LevelFit& fit) const {
  std::size_t used = 0;
  for (const Foot& foot : fit.feet()) used += foot.is_used();
  std::size_t against = 0;
  if (!thin_.normal.empty()) {
    Array<Foot> any;
    fit.finder().find(any, true);
    for (std::size_t s = 0; s < any.size(); ++s)
      against += any[s].cell >= 0 &&
                 thin_.normal[s].cast<double>().dot(fit.finder().normal_at(any[s])) < 0;
  }
  if (2 * against > thin_.size())
    throw FairingError(ErrorCode::inconsistent_orientation,
                       {"Most normals of the scan point against those of the control mesh.",
                        "Flip the normals of one of them: both have to point outwards."},
                       {}, ElementKind::mesh);
  if (used < fewest_points)
    throw FairingError(
        ErrorCode::bad_shape,
        {"Only " + std::to_string(used) + " points of the scan lie over the control mesh.",
         "Move one onto the other, or draw the control mesh over the scan."});
}

// With curves it takes more iterations, since curves and surface move alternately. Curves move
// first: a surface that comes to a distant scan without them has a wall at its border.
void FitLevels::fit_curves(LevelFit& fit, double weight, int iterations, bool robust) {
  if (!curves_.any()) return fit.iterate(weight, iterations, robust);
  for (int k = 0; k < 3 * iterations; ++k) {
    curves_.move(fit, weight, control_);
    Array<double> x = fit.surface();
    levels_.put_fixed(fit.level(), data(), x.data());
    fit.set_surface(std::move(x), fit.feet());
    fit.iterate(weight, 1, robust);
  }
}

// The weight from the coarser level may miss the tolerance on the finest.
void FitLevels::keep_tolerance(LevelFit& fit) {
  if (!(settings_.tolerance > 0) || !is_kept_) return;
  while (covered_within(fit.feet()) * problem_.frame.scale > settings_.tolerance &&
         weight_ < fit.stiffest()) {
    weight_ *= std::sqrt(std::numbers::sqrt2);
    fit.iterate(weight_, 2, true);
  }
}

// Faces without points are kept near the control polyhedron, by a weight so small that it matters
// only where several of them are adjacent.
Prior FitLevels::prior(const LevelFit& fit) const {
  constexpr double weak = 1e-3;  // keeps waves of at least five control edges
  const Cells& cells = fit.cells();
  std::vector<Index> count(levels_.grid(0).mesh().faces.size());
  for (const Foot& foot : fit.feet())
    if (foot.is_used()) ++count[cells.face(foot.cell)];
  if (std::find(count.begin(), count.end(), 0) == count.end()) return {};
  Prior out;
  out.place.resize(3 * cells.grid().size());
  refine_linearly(cells.grid(), control_.working, levels_.workers(), out.place.data());
  out.weight.assign(cells.grid().size(), 0.0);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (count[cells.face(Index(c))] > 0) continue;
    const double held = weak * unit_ * cell_area(cells, out.place.data(), Index(c));
    const int corners = cells.quad(Index(c)) ? 4 : 3;
    for (int k = 0; k < corners; ++k) out.weight[cells.corners(Index(c))[k]] += held / corners;
  }
  return out;
}

Array<double> FitLevels::above(const LevelFit& fit) {
  const int level = fit.level() + 1;
  Array<double> x(3 * levels_.grid(level).size());
  levels_.start(level, data(), fit.surface(), x);
  return x;
}

}  // namespace fairing
