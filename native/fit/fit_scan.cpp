// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/fit_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/points.h"
#include "fairing/extremes.h"
#include "fairing/memory_plan.h"
#include "fairing/warnings.h"
#include "fit/fit_levels.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

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
          "Draw the control mesh nearer to the scan, in the same unit, or leave out what is not "
          "scanned."},
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
  FitLevels fit(*problem, levels, scan, own_settings, monitor);
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
  to_world(fit.control(), finest, problem->frame, workers, fit.surface().data(),
           result.vertices.data());
  require_finite(problem->mesh, fit.control(), workers, result.vertices.size(),
                 result.vertices.data());
  warn_of_fit(result.fit, settings.tolerance, report);
  report.largest_deviation = largest_deviation(problem->basis.cage, result.vertices.data());
  JoinedSheets(finest).join(result.vertices);
  finish(*problem, ledger, watch, monitor, result);
  return result;
}

// Gives faces of the mended mesh the ids of the input; a face in pieces has the mean of their
// coverage.
void restore(const Mending& mending, std::int64_t faces, FitReport& fit) {
  if (!mending.mended()) return;
  const auto& origin = mending.mended()->face_origin;
  for (std::int32_t& f : fit.faces)
    if (f >= 0) f = std::int32_t(origin[f]);
  fit.too_coarse = mending.faces_of_input(fit.too_coarse);
  std::vector<double> sum(faces), pieces(faces);
  for (std::size_t f = 0; f < origin.size(); ++f) {
    sum[origin[f]] += fit.coverage[f];
    pieces[origin[f]] += 1;
  }
  fit.coverage.resize(sum.size());
  for (std::size_t f = 0; f < sum.size(); ++f) fit.coverage[f] = sum[f] / pieces[f];
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
    restore(mending, mesh.face_count(), result.fit);
    return result;
  });
}

}  // namespace fairing
