// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/variation.h"

#include <limits>
#include <utility>

#include "curvature/fold_repair.h"
#include "parallel/reductions.h"
#include "transfer/quadratic.h"

namespace fairing {
namespace {

// The variation of such a start says nothing, since prolongation leaves short waves, which the
// first step removes (measured: its variation is two to six times that of the surface of least
// total curvature, and it is ten times nearer to the solution).
void add_prolonged(SurfaceIterate& it, const Array<double> below) {
  const GridLevel& grid = it.grid();
  Array<double> change(3 * grid.size());
  ElementSlots<double, 3> slots;
  prolong(it.system.grid(it.level - 1), grid, it.system.stencils(), &it.system.shared().unknowns,
          it.workers(), slots, below.data(), change.data());
  LinearizedSurface& start = it.current;
  for_each_index(it.workers(), grid.size(), [&](std::size_t i) {
    const Eigen::Map<const Vec3> normal(start.linearization.normal.data() + 3 * i),
        moved(change.data() + 3 * i);
    Eigen::Map<Vec3>(start.points.data() + 3 * i) += moved.dot(normal) * normal;
  });
  it.system.symmetrize(it.level, start.points);
  it.linearize(of_variation);
}

// Makes iterate.current the surface of least variation. Returns whether it varies less and, if the
// steps have not converged, has no more folds; with a penalty they have to converge, since rims wave
// on the way there: a mug's turned by 524 degrees for 360, total curvature's by 408.
bool vary(SurfaceIterate& it, VariationBelow& below, const StopCriterion& end,
          CurvatureLevelReport& report) {
  const Array<double> start = it.current.points;
  it.linearize(of_variation);
  report.start_variation = it.current.energy;
  const std::size_t folds = folds_of(it).count();
  const double most =
      equal_energy * report.start_variation + flat_energy_about(it.current, it.workers());
  const auto steps_fall = [&] {
    run_to_variation(it, end, report);
    const bool may_keep = report.converged || (!it.op().penalty() && folds_of(it).count() <= folds);
    if (it.current.energy <= most && may_keep) return true;
    it.current.points = start;
    it.linearize(of_variation);
    return false;
  };
  if (!below.change.empty()) {
    add_prolonged(it, std::exchange(below.change, {}));
    if (steps_fall()) return true;
  }
  return steps_fall();
}

}  // namespace

void run_variation(SurfaceIterate& it, VariationBelow& below, const StopCriterion& end,
                   CurvatureLevelReport& report) {
  if (!(it.current.energy > flat_energy)) return;
  const Functional total_curvature = it.current.functional;
  report.kept_start = !vary(it, below, end, report);
  report.variation = it.current.energy;
  if (report.kept_start) {
    report.left = std::numeric_limits<double>::infinity();
    report.converged = false;
  }
  it.linearize(total_curvature);
  report.energy = it.op().objective();
}

void prepare_variation(SurfaceIterate& it, VariationBelow& below, const StopCriterion& end) {
  if (!(it.current.energy > flat_energy)) return;
  const LinearizedSurface start = it.current;
  CurvatureLevelReport report;
  const bool falls = vary(it, below, end, report);
  below.vanishes = falls && it.current.energy <= flat_energy_about(it.current, it.workers());
  if (falls && !below.vanishes) {
    below.change = it.current.points;
    for_each_index(it.workers(), below.change.size(),
                   [&](std::size_t i) { below.change[i] -= start.points[i]; });
  }
  it.current = start;
}

}  // namespace fairing
