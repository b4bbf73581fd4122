// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/variation.h"

#include <limits>
#include <utility>

#include "parallel/reductions.h"
#include "transfer/quadratic.h"

namespace fairing {

// The variation of such a start says nothing, since prolongation leaves short waves, which the
// first step removes (measured: its variation is two to six times that of the surface of least
// total curvature, and it is ten times nearer to the solution).
bool VariationSteps::begin_with_change() {
  if (change_.empty()) return false;
  const Array<double> below = std::exchange(change_, {});
  const GridLevel& grid = iterate_.grid();
  Array<double> change(3 * grid.size());
  ElementSlots<double, 3> slots;
  prolong(iterate_.system.grid(iterate_.level - 1), grid, iterate_.system.stencils(),
          &iterate_.system.shared().unknowns, iterate_.workers(), slots, below.data(),
          change.data());
  LinearizedSurface& start = iterate_.current;
  for_each_index(iterate_.workers(), grid.size(), [&](std::size_t i) {
    const Eigen::Map<const Vec3> normal(start.linearization.normal.data() + 3 * i),
        moved(change.data() + 3 * i);
    Eigen::Map<Vec3>(start.points.data() + 3 * i) += moved.dot(normal) * normal;
  });
  iterate_.system.symmetrize(iterate_.level, start.points);
  iterate_.linearize(of_variation);
  return true;
}

void VariationSteps::go_to(const Array<double>& points) {
  iterate_.current.points = points;
  iterate_.linearize(of_variation);
}

// Returns whether the steps from iterate.current end at no more than `most`.
bool VariationSteps::steps_fall(double most, const StopCriterion& end,
                                CurvatureLevelReport& report) {
  steps_.run_variation(end, report);
  return iterate_.current.energy <= most;
}

// Makes iterate.current the surface of least variation. Returns whether it varies less.
bool VariationSteps::vary(const Array<double>& start, const StopCriterion& end,
                          CurvatureLevelReport& report) {
  iterate_.linearize(of_variation);
  report.start_variation = iterate_.current.energy;
  const double most = equal_energy * report.start_variation +
                      flat_energy_about(iterate_.current, iterate_.workers());
  if (begin_with_change()) {
    if (steps_fall(most, end, report)) return true;
    go_to(start);
  }
  if (steps_fall(most, end, report)) return true;
  go_to(start);
  return false;
}

void VariationSteps::run(const StopCriterion& end, CurvatureLevelReport& report) {
  if (!(iterate_.current.energy > flat_energy)) return;
  const Functional total_curvature = iterate_.current.functional;
  report.kept_start = !vary(Array<double>(iterate_.current.points), end, report);
  report.variation = iterate_.current.energy;
  if (report.kept_start) {
    report.left = std::numeric_limits<double>::infinity();
    report.converged = false;
  }
  iterate_.linearize(total_curvature);
  report.energy = iterate_.op().objective();
}

void VariationSteps::prepare_next_level(const StopCriterion& end) {
  if (!(iterate_.current.energy > flat_energy)) return;
  const LinearizedSurface start = iterate_.current;
  CurvatureLevelReport report;
  const bool falls = vary(start.points, end, report);
  const LinearizedSurface& found = iterate_.current;
  vanishes_ = falls && found.energy <= flat_energy_about(found, iterate_.workers());
  if (falls && !vanishes_) {
    change_ = iterate_.current.points;
    for_each_index(iterate_.workers(), change_.size(),
                   [&](std::size_t i) { change_[i] -= start.points[i]; });
  }
  iterate_.current = start;
}

}  // namespace fairing
