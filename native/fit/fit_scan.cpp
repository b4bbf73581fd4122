// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/fit_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/points.h"
#include "curvature/area.h"
#include "fairing/extremes.h"
#include "fairing/memory_plan.h"
#include "fairing/warnings.h"
#include "fit/curves.h"
#include "fit/level_fit.h"
#include "fit/measure.h"
#include "fit/round_off.h"
#include "fit/weight_choice.h"
#include "grid/linear.h"
#include "parallel/cancel.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// The level on which the weight is chosen: the waves that matter are longer than its edges. Coarse
// control meshes with many points a face use a finer level.
constexpr int level_of_search = 2;
// Most cells of that level, since the choice takes some twenty iterations.
constexpr std::size_t cells_of_search = std::size_t(1) << 14;
// Number of points for the choice of the weight; more do not improve it.
constexpr std::size_t enough_points = std::size_t(1) << 18;

FairOptions options_of_fit(const FairOptions& given, const FitSettings& settings,
                           std::size_t vertices) {
  if (given.energy != Energy::thin_plate)
    throw FairingError(ErrorCode::bad_option, {"A surface is fitted to a scan by the thin plate.",
                                               "Use energy=\"thin_plate\"."});
  if (given.interpolation != Interpolation::exact)
    throw FairingError(ErrorCode::bad_option,
                       {"A fit moves all control vertices that are not fixed.",
                        "Use interpolation=\"exact\", and fixed for vertices that stay."});
  if (given.paper.needs_point_forces() || given.paper.method == Method::back_leg)
    throw FairingError(ErrorCode::bad_option,
                       {"The paper's own options are not for fits.", "Leave them out."});
  if (given.shape_count(3 * vertices) > 0)
    throw FairingError(ErrorCode::bad_option, {"A fit has no shapes.", "Leave them out."});
  FairOptions options = given;
  options.interpolation = Interpolation::approximate;
  options.tolerance = {0.0};
  options.weights.assign(vertices, 1.0);
  for (std::size_t v = 0; v < settings.fixed.size(); ++v)
    if (settings.fixed[v]) options.weights[v] = std::numeric_limits<double>::infinity();
  options.pad_size = 0;
  options.measure = false;
  return options;
}

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
  const auto cells = [&](int l) { return mesh.faces.size() << (2 * l); };
  while (level < top && cells(level + 1) <= cells_of_search &&
         double(points) >= points_a_blob * double(cells(level + 1)))
    ++level;
  return level;
}

double area_of(const GridLevel& grid, Workers& workers, const std::vector<Vec3>& control) {
  Array<double> x(3 * grid.size());
  refine_linearly(grid, control, workers, x.data());
  return surface_area(grid, workers, x.data());
}

class ScanFit {
 public:
  ScanFit(const FairingProblem& problem, ThinPlateLevels& levels, const Scan& scan,
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

  void run(FitReport& report) {
    const FitProblem rough = problem_of(thin_);
    auto fit = std::make_unique<LevelFit>(rough, search_);
    begin(*fit);
    WeightChoice choice(*fit, settings_, problem_.frame.scale);
    weight_ = choice.choose(monitor_);
    report.trials = choice.trials();
    is_kept_ = choice.is_by_tolerance();
    weight_ *= choice.more_points(thin_.size());
    const bool is_automatic = !(settings_.weight > 0) && !choice.is_by_tolerance();
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
      if (is_automatic && level > search_) weight_ *= std::pow(std::max(left_below / left, 1.0), 2);
      left_below = left;
      fit_curves(*fit, weight_, 2, true);
      monitor_.report(Phase::solve, 1 - std::pow(2, level - levels_.top() - 3));
    }
    keep_tolerance(*fit);
    round_off(*fit, weight_);
    report.iterations += fit->iterations();
    report.weight = weight_;
    surface = fit->surface();
    measure_fit(*fit, problem_, report);
  }

  Array<double> surface;
  const ControlPositions& control() const { return control_; }

 private:
  FitProblem problem_of(const Scan& scan) const {
    return {levels_,
            scan,
            unit_,
            area_,
            problem_.units.edge_in_space,
            problem_.options.solve.max_iterations,
            monitor_};
  }
  PlateData data() const { return {control_.working, control_.working_curves}; }

  // Moves a smooth surface from the control polyhedron to the scan: distant feet carry no detail.
  void begin(LevelFit& fit) {
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

  void require_match(const LevelFit& fit) const;

  // With curves it takes more iterations, since surface and curves move alternately.
  void fit_curves(LevelFit& fit, double weight, int iterations, bool robust) {
    if (!curves_.any()) return fit.iterate(weight, iterations, robust);
    for (int k = 0; k < 3 * iterations; ++k) {
      fit.iterate(weight, 1, robust);
      curves_.move(fit, weight, control_);
      Array<double> x = fit.surface();
      levels_.put_fixed(fit.level(), data(), x.data());
      fit.set_surface(std::move(x), fit.feet());
    }
    fit.iterate(weight, 1, robust);
  }

  // The weight from the coarser level may miss the tolerance on the finest.
  void keep_tolerance(LevelFit& fit) {
    if (!(settings_.tolerance > 0) || !is_kept_) return;
    while (covered_within(fit.feet()) * problem_.frame.scale > settings_.tolerance &&
           weight_ < fit.stiffest()) {
      weight_ *= std::sqrt(std::numbers::sqrt2);
      fit.iterate(weight_, 2, true);
    }
  }

  // Faces without points are kept near the control polyhedron, by a weight so small that it matters
  // only where several of them are adjacent.
  Prior prior(const LevelFit& fit) const {
    constexpr double weak = 1e-3;  // keeps waves of at least five control edges
    const Cells& cells = fit.cells();
    std::vector<Index> count(levels_.grid(0).mesh().faces.size());
    for (const Foot& foot : fit.feet())
      if (foot.is_used()) ++count[std::size_t(cells.face(foot.cell))];
    if (std::find(count.begin(), count.end(), 0) == count.end()) return {};
    Prior out;
    out.place.resize(3 * cells.grid().size());
    refine_linearly(cells.grid(), control_.working, levels_.workers(), out.place.data());
    out.weight.assign(cells.grid().size(), 0.0);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (count[std::size_t(cells.face(Index(c)))] > 0) continue;
      const double held = weak * unit_ * cell_area(cells, out.place.data(), Index(c));
      const int corners = cells.quad(Index(c)) ? 4 : 3;
      for (int k = 0; k < corners; ++k)
        out.weight[std::size_t(cells.corners(Index(c))[std::size_t(k)])] += held / corners;
    }
    return out;
  }

  Array<double> above(const LevelFit& fit) {
    const int level = fit.level() + 1;
    Array<double> x(3 * levels_.grid(level).size());
    levels_.start(level, data(), fit.surface(), x);
    return x;
  }

  const FairingProblem& problem_;
  ThinPlateLevels& levels_;
  const Scan& scan_;
  const FitSettings& settings_;
  Monitor& monitor_;
  ControlPositions control_;
  CurveFit curves_;
  int search_;
  Scan thin_;
  double unit_, area_, weight_ = 0;
  bool is_kept_ = false;  // whether the tolerance is met
};

// Throws if most points are on the surface's other side, or hardly any has a foot.
void ScanFit::require_match(const LevelFit& fit) const {
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

// Adds the memory of a fit to that predicted for the plate.
void require_room(const PolygonMesh& input, const FairingProblem& problem, std::size_t points,
                  Report& report) {
  const FairOptions& options = problem.options;
  RunSize size = predict_size(input.vertex_count(), input.corners, input.offsets, 0, options);
  constexpr std::int64_t vectors = 4 * sizeof(Vec3);  // surface, residual, target, forces
  // kept for all points, and again for the points that choose the weight, with the best feet
  constexpr std::int64_t in_iteration = sizeof(Foot) + sizeof(float) + sizeof(Index),
                         in_report = sizeof(Foot) + sizeof(double) + sizeof(std::int32_t),
                         in_choice = Scan::bytes_a_point + in_iteration + sizeof(Foot);
  size.bytes = std::int64_t(report.predicted_bytes) +
               (Scan::bytes_a_point + in_iteration + in_report) * std::int64_t(points) +
               in_choice * std::int64_t(std::min(points, enough_points)) +
               (Cells::bytes_a_point + PointForces::bytes_a_cell + vectors) * size.solved;
  require_fit(size, options);
  report.predicted_bytes = std::size_t(size.bytes);
  expect_memory(report);
}

void warn_of_fit(const FitReport& fit, double tolerance, Report& report) {
  if (tolerance > 0 && fit.within > tolerance)
    report.warnings.push_back(
        {"TOLERANCE_NOT_KEPT",
         {"The tolerance could not be kept: 95 % of the points are within " +
              length_text(fit.within) + " of the surface, and their noise is about " +
              length_text(fit.noise) + ".",
          "Use a tolerance over twice the noise, more levels, or a finer control mesh."},
         {}});
  double covered = 0;
  for (const double share : fit.coverage) covered += share / double(fit.coverage.size());
  if (2 * covered < 1)
    report.warnings.push_back(
        {"MOSTLY_UNCOVERED",
         {"The scan has points over " + std::to_string(int(100 * covered)) +
              " % of the control mesh only.",
          "Draw the control mesh nearer to the scan, or leave out what is not scanned."},
         {}});
}

FitResult fit_all(const PolygonMesh& input, const FairOptions& options, const ScanInput& given,
                  const FitSettings& settings, const MemoryLedger& ledger, Monitor& monitor) {
  const CancelScope scope(&monitor);
  FitResult result;
  Report& report = result.report;
  Stopwatch watch(report, monitor);
  const std::unique_ptr<const FairingProblem> problem = make_problem(input, options, watch, report);
  Workers& workers = *problem->workers;
  const Scan scan = make_scan(given, problem->frame, workers);
  require_same_place(scan, problem->basis.working, problem->frame);
  require_room(input, *problem, scan.size(), report);
  watch.enter(Phase::hierarchy, 0);
  ThinPlateOptions own;
  own.levels = options.levels;
  own.solve = options.solve;
  ThinPlateLevels levels(problem->mesh, problem->stencils, problem->unknowns, {}, own, workers,
                         monitor);
  watch.enter(Phase::solve, 0.125);
  FitSettings own_settings = settings;
  if (!settings.fixed.empty()) own_settings.fixed.resize(std::size_t(problem->mesh.input_vertices));
  ScanFit fit(*problem, levels, scan, own_settings, monitor);
  fit.run(result.fit);
  watch.enter(Phase::output, 0.875);
  const GridLevel& finest = levels.grid(levels.top());
  LevelReport level;
  level.level = levels.top();
  level.points = finest.size();
  level.unknowns = levels.unknowns_of(levels.top());
  level.iterations = result.fit.iterations;
  level.converged = true;
  report.levels.push_back(level);
  report.result = report.polyhedron = report.prediction = {NAN, NAN};
  result.vertices.resize(3 * finest.size());
  to_world(fit.control(), finest, problem->frame, workers, fit.surface.data(),
           result.vertices.data());
  require_finite(problem->mesh, fit.control(), workers, result.vertices.size(),
                 result.vertices.data());
  warn_of_fit(result.fit, settings.tolerance, report);
  report.largest_deviation = largest_deviation(problem->basis.cage, result.vertices.data());
  JoinedSheets(finest).join(result.vertices);
  finish(*problem, ledger, watch, monitor, result);
  return result;
}

}  // namespace

FitResult fit_scan(const PolygonMesh& mesh, const FairOptions& options, const ScanInput& scan,
                   const FitSettings& settings, Monitor& monitor) {
  return with_named_errors([&] {
    const FairOptions own = options_of_fit(options, settings, std::size_t(mesh.vertex_count()));
    const MemoryLedger ledger(own.bytes_allowed());
    const Mending mending(mesh, own);
    FitResult result = mending.in_input_ids([&] {
      return fit_all(mending.mesh(), mending.options(), scan, settings, ledger, monitor);
    });
    restore(mending, result);
    return result;
  });
}

}  // namespace fairing
