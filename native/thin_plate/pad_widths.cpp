// SPDX-License-Identifier: GPL-3.0-or-later
// The plate's part in choosing the widths of pads (hold/pad_widths.h): both surfaces that are
// compared are linear solves.
#include "hold/pad_widths.h"

#include "parallel/reductions.h"
#include "thin_plate/solver.h"

namespace fairing {
namespace {

// How far the solves go that only judge: point forces need no more for energies to a few
// thousandths, and pads read forces from what is left.
constexpr double needle_tolerance = 1e-2, tolerance = 1e-4;

}  // namespace

LevelReport ThinPlateSolver::choose_widths(int level, std::span<const Vec3> targets,
                                           const PcgLimits& limits, Array<double>& x) {
  widths_chosen_ = true;
  if (!options_.star_energies) return solve_level(level, targets, limits, x.data());
  PcgLimits rough = limits;
  rough.tolerance = std::max(limits.tolerance, tolerance);
  HoldInSpace* constraint = nullptr;
  std::swap(constraint, constraint_);
  std::vector<double> of_needles;
  {
    Array<double> needles(3 * grid(level).size());
    for_each_index(workers_, needles.size(), [&](std::size_t i) { needles[i] = x[i]; });
    PcgLimits rougher = limits;
    rougher.tolerance = std::max(limits.tolerance, needle_tolerance);
    std::unique_ptr<Pads> pads;
    const Moments moments = moments_;
    std::swap(pads, pads_);
    solve_level(level, targets, rougher, needles.data());
    std::swap(pads, pads_);
    moments_ = moments;
    of_needles = options_.star_energies(grid(level), needles.data());
  }
  judges_ = true;
  LevelReport report = solve_level(level, targets, rough, x.data());
  int iterations = 0, corrections = 0;
  const auto again = [&](const PcgLimits& now) {
    iterations += report.iterations;
    corrections += report.pad_corrections;
    report = solve_level(level, targets, now, x.data());
  };
  for (int round = 0;; ++round) {
    const std::vector<int> halvings =
        halvings_of_pads(grid(0), *pads_, plate_limits,
                         options_.star_energies(grid(level), x.data()), of_needles, round);
    if (halvings.empty()) break;
    narrow_pads<3>(halvings, *pads_, loads_);
    again(rough);
  }
  std::swap(constraint, constraint_);
  judges_ = false;
  if (constraint_ || level == top()) again(limits);
  report.iterations += iterations;
  report.pad_corrections += corrections;
  return report;
}

}  // namespace fairing
