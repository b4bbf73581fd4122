// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/fallback.h"

#include <algorithm>
#include <utility>

#include "grid/runs.h"
#include "mesh/sharp_turn.h"

namespace fairing {
namespace {

using Normal = Eigen::Map<const Vec3>;

// For each control vertex the least cosine between its normal and those at the points of its star.
// Points on curves have no normal and are skipped.
std::vector<double> least_cosines_of_stars(const GridLevel& grid, const Array<double>& normals) {
  const ControlMesh& mesh = grid.mesh();
  std::vector<double> least(std::size_t(mesh.vertex_count()), 1.0);
  const auto normal = [&](std::size_t p) { return Normal(normals.data() + 3 * p); };
  const auto visit = [&](Index v, const Run& run) {
    double& cosine = least[std::size_t(v)];
    for (std::size_t p = run.first; p < run.first + run.count; ++p)
      if (!normal(p).isZero(0)) cosine = std::min(cosine, normal(std::size_t(v)).dot(normal(p)));
  };
  for_each_run(grid, [&](const Run& run) {
    if (run.kind == RunKind::edge)
      for (const Index v : mesh.edges[std::size_t(run.element)].vertex) visit(v, run);
    else if (run.kind == RunKind::face_row)
      for (int c = 0; c < mesh.faces[std::size_t(run.element)].size; ++c)
        visit(mesh.faces[std::size_t(run.element)].vertex[std::size_t(c)], run);
  });
  return least;
}

}  // namespace

void FallbackSteps::run(Pads* pads, const StepStart& start, CurvatureLevelReport& report) {
  run_on_points(start, report);
  if (it_.level < it_.system.finest()) return;
  if (pads && report.folds_before > 0)
    deactivate_all(*pads);
  else if (pads)
    move_to_pads(*pads, start, report);
  report.converged = report.left <= steps_.accurate_end().movement;
  // Vertices within tolerances are fixed first.
  if (!report.converged && !it_.system.is_bound()) polish(report);
}

void FallbackSteps::polish(CurvatureLevelReport& report) {
  if (!is_near(report, damped_decrement)) return;
  LinearizedSurface before = it_.current;
  CurvatureLevelReport polished = report;
  steps_.polish(longest_climb, polished);
  polished.folds = fold_repair_.find().count();
  if (polished.folds <= report.folds)
    report = std::move(polished);
  else
    it_.current = std::move(before);
}

void FallbackSteps::run_on_points(const StepStart& start, CurvatureLevelReport& report) {
  steps_.run_damped(nullptr, start, {}, report);
  if (it_.level == it_.system.finest()) fold_repair_.run(start, report);
}

// Accepts the surface on pads if it has hardly more energy than the one on points, no more folds,
// and is as near to a solution; otherwise all vertices stay on point forces.
void FallbackSteps::move_to_pads(Pads& pads, const StepStart& start, CurvatureLevelReport& report) {
  deactivate_turned(pads);
  if (!pads.any()) return;
  LinearizedSurface on_points = it_.current;
  const CurvatureLevelReport of_points = report;
  StepStart from{it_.current.points, it_.current.held, start.report};
  from.held.loads.clear();
  steps_.run_damped(&pads, from, {}, report);
  report.folds_before = of_points.folds_before;
  report.folds = fold_repair_.find().count();
  // There is no step if nothing is bent at the start, or if no step is possible.
  const bool ends = report.steps.empty() ? report.converged : report.steps.back().length > 0;
  const bool is_as_near =
      ends && is_near(report, damped_decrement) >= is_near(of_points, damped_decrement);
  if (report.energy <= other_minimum * of_points.energy && report.folds <= of_points.folds &&
      is_as_near)
    return;
  deactivate_all(pads);
  it_.current = std::move(on_points);
  report = of_points;
}

void FallbackSteps::deactivate_all(Pads& pads) {
  for (std::size_t v = 0; v < pads.places().size(); ++v) deactivate(pads, v);
}

// A load acts along the normals of its pad. If these turn sharply away from the vertex's normal,
// less than half of the load holds the vertex, and neighbouring pads oppose each other.
void FallbackSteps::deactivate_turned(Pads& pads) {
  const std::vector<double> facing =
      least_cosines_of_stars(it_.grid(), it_.current.linearization.normal);
  for (std::size_t v = 0; v < facing.size(); ++v)
    if (facing[v] < sharp_turn) deactivate(pads, v);
}

void FallbackSteps::deactivate(Pads& pads, std::size_t v) {
  pads.deactivate(v);
  if (!it_.current.held.loads.empty()) it_.current.held.loads[v].setZero();
}

}  // namespace fairing
