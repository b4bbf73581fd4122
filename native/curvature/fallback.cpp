// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/fallback.h"

#include <algorithm>
#include <utility>

#include "curvature/fold_repair.h"
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
    double& cosine = least[v];
    for (std::size_t p = run.first; p < run.first + run.count; ++p)
      if (!normal(p).isZero(0)) cosine = std::min(cosine, normal(std::size_t(v)).dot(normal(p)));
  };
  for_each_run(grid, [&](const Run& run) {
    if (run.kind == RunKind::edge)
      for (const Index v : mesh.edges[run.element].vertex) visit(v, run);
    else if (run.kind == RunKind::face_row)
      for (int c = 0; c < mesh.faces[run.element].size; ++c)
        visit(mesh.faces[run.element].vertex[c], run);
  });
  return least;
}

void deactivate(SurfaceIterate& it, Pads& pads, std::size_t v) {
  pads.deactivate(v);
  if (!it.current.held.loads.empty()) it.current.held.loads[v].setZero();
}

void deactivate_all(SurfaceIterate& it, Pads& pads) {
  for (std::size_t v = 0; v < pads.places().size(); ++v) deactivate(it, pads, v);
}

// A load acts along the normals of its pad. If these turn sharply away from the vertex's normal,
// less than half of the load holds the vertex, and neighbouring pads oppose each other.
void deactivate_turned(SurfaceIterate& it, Pads& pads) {
  const std::vector<double> facing =
      least_cosines_of_stars(it.grid(), it.current.linearization.normal);
  for (std::size_t v = 0; v < facing.size(); ++v)
    if (facing[v] < sharp_turn) deactivate(it, pads, v);
}

// Accepts the surface on pads if it has hardly more energy than the one on points, no more folds,
// and is as near to a solution; otherwise all vertices stay on point forces.
void move_to_pads(SurfaceIterate& it, Pads& pads, const StepStart& start,
                  CurvatureLevelReport& report) {
  deactivate_turned(it, pads);
  if (!pads.any()) return;
  LinearizedSurface on_points = it.current;
  const CurvatureLevelReport of_points = report;
  StepStart from{it.current.points, it.current.held, start.report};
  from.held.loads.clear();
  run_damped(it, &pads, from, {}, report);
  report.folds_before = of_points.folds_before;
  report.folds = folds_of(it).count();
  // There is no step if nothing is bent at the start, or if no step is possible.
  const bool ends = report.steps.empty() ? report.converged : report.steps.back().length > 0;
  const bool is_as_near =
      ends && is_near(report, damped_decrement) >= is_near(of_points, damped_decrement);
  if (report.energy <= other_minimum * of_points.energy && report.folds <= of_points.folds &&
      is_as_near)
    return;
  deactivate_all(it, pads);
  it.current = std::move(on_points);
  report = of_points;
}

// Plain steps to the end, undone if they make folds.
void polish_without_folds(SurfaceIterate& it, CurvatureLevelReport& report) {
  if (!is_near(report, damped_decrement)) return;
  LinearizedSurface before = it.current;
  CurvatureLevelReport polished = report;
  polish(it, longest_climb, polished);
  polished.folds = folds_of(it).count();
  if (polished.folds <= report.folds)
    report = std::move(polished);
  else
    it.current = std::move(before);
}

}  // namespace

void run_fallback(SurfaceIterate& it, Pads* pads, const StepStart& start,
                  CurvatureLevelReport& report) {
  run_damped(it, nullptr, start, {}, report);
  if (it.level < it.system.finest()) return;
  repair_folds(it, start, report);
  if (pads && report.folds_before > 0)
    deactivate_all(it, *pads);
  else if (pads)
    move_to_pads(it, *pads, start, report);
  report.converged = report.left <= accurate_end(it).movement;
  // Vertices within tolerances are fixed first.
  if (!report.converged && !it.system.is_bound()) polish_without_folds(it, report);
}

}  // namespace fairing
