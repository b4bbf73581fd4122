// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/fallback.h"

#include <utility>

#include "curvature/fold_repair.h"

namespace fairing {
namespace {

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

void run_fallback(SurfaceIterate& it, const StepStart& start, CurvatureLevelReport& report) {
  run_damped(it, start, {}, report);
  if (it.level < it.system.finest()) return;
  repair_folds(it, start, report);
  report.converged = report.left <= accurate_end(it).movement;
  // Vertices within tolerances are fixed first.
  if (!report.converged && !it.system.is_bound()) polish_without_folds(it, report);
}

}  // namespace fairing
