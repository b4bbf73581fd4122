// SPDX-License-Identifier: GPL-3.0-or-later
// How wide each pad is. A wide pad asks a crumpled mesh for more than it can give: between folds
// and on thin fins the loads throw the surface about, and its curvature is many times what point
// forces leave. There the pad gives way. Both surfaces are linear solves, and a coarse level shows
// enough.
#include <algorithm>
#include <cmath>

#include "grid/ring.h"
#include "parallel/reductions.h"
#include "thin_plate/solver.h"

namespace fairing {
namespace {

// A star's energy on pads may be so many times that on point forces, and so many mean stars'
// energies above: what hardly bends may bend a little more, and rounding decides nothing.
constexpr double most_of_star = 1.2, slack = 0.5;
// The whole surface's may be so many times that on point forces; while it is more, stars are judged
// by this in place of both.
constexpr double most_of_all = 1.1, most_when_strict = 1.05;
constexpr int patient_rounds = 4;  // afterwards pads go at once, without halves
constexpr int to_nothing = 8;      // halvings
constexpr int farthest = 4;        // rings around a star, in which pads may be why it bends
// How far the solves go that only judge.
constexpr double tolerance = 1e-4;

// The nearest control vertices on pads, ring by ring: v itself, or all in the first ring that has
// any. Empty beyond `farthest` rings. `control` is level 0, whose points are the control vertices.
std::vector<Index> nearest_pads(const GridLevel& control, const Pads& pads, Index v) {
  std::vector<Index> ring{v}, seen{v}, found;
  for (int distance = 0; distance <= farthest; ++distance) {
    for (const Index w : ring)
      if (pads.under(std::size_t(w))) found.push_back(w);
    if (!found.empty()) break;
    std::vector<Index> next;
    for (const Index w : ring)
      visit_ring(control, w, [&](Index u, std::size_t) {
        if (std::find(seen.begin(), seen.end(), u) != seen.end()) return;
        seen.push_back(u);
        next.push_back(u);
      });
    ring = std::move(next);
  }
  return found;
}

}  // namespace

// Whether any has given way. All stars are judged before any pad changes, so that the order of
// vertices does not matter.
bool ThinPlateSolver::narrow_pads(const std::vector<double>& energy,
                                  const std::vector<double>& of_needles, int round) {
  double sum = 0, sum_of_needles = 0;
  for (const double e : energy) sum += e;
  for (const double e : of_needles) sum_of_needles += e;
  const bool strict = sum > most_of_all * sum_of_needles;
  const double most = strict ? most_when_strict : most_of_star,
               above = strict ? 0 : slack * sum_of_needles / double(of_needles.size());
  std::vector<int> halvings(energy.size(), 0);
  for (std::size_t v = 0; v < energy.size(); ++v) {
    const double excess = energy[v] / (most * of_needles[v] + above);
    if (!pads_->began_under(v) || !(excess > 1)) continue;
    const int times = round >= patient_rounds
                          ? to_nothing
                          : 1 + int(std::log2(std::min(excess, std::ldexp(1.0, to_nothing - 1))));
    for (const Index w : nearest_pads(grid(0), *pads_, Index(v)))
      halvings[std::size_t(w)] = std::max(halvings[std::size_t(w)], times);
  }
  bool any = false;
  for (std::size_t v = 0; v < halvings.size(); ++v) {
    if (halvings[v] == 0) continue;
    any = true;
    const double before = pads_->widths()[v];
    pads_->narrow(v, halvings[v]);
    // The whole force stays about the same.
    loads_[v] *= pads_->under(v) ? before / pads_->widths()[v] : 0.0;
  }
  return any;
}

LevelReport ThinPlateSolver::choose_widths(int level, std::span<const Vec3> targets,
                                           const PcgLimits& limits, Array<double>& x) {
  widths_chosen_ = true;
  if (!options_.star_energies) return solve_level(level, targets, limits, x.data());
  PcgLimits rough = limits;
  rough.tolerance = std::max(limits.tolerance, tolerance);
  ToleranceConstraint* constraint = nullptr;
  std::swap(constraint, constraint_);
  std::vector<double> of_needles;
  {
    Array<double> needles(3 * grid(level).size());
    for_each_index(workers_, needles.size(), [&](std::size_t i) { needles[i] = x[i]; });
    std::unique_ptr<Pads> pads;
    std::swap(pads, pads_);
    solve_level(level, targets, rough, needles.data());
    std::swap(pads, pads_);
    of_needles = options_.star_energies(grid(level), needles.data());
  }
  LevelReport report = solve_level(level, targets, rough, x.data());
  int iterations = 0, corrections = 0;
  const auto again = [&](const PcgLimits& now) {
    iterations += report.iterations;
    corrections += report.pad_corrections;
    report = solve_level(level, targets, now, x.data());
  };
  for (int round = 0; narrow_pads(options_.star_energies(grid(level), x.data()), of_needles, round);
       ++round)
    again(rough);
  std::swap(constraint, constraint_);
  if (constraint_ || limits.tolerance < rough.tolerance) again(limits);
  report.iterations += iterations;
  report.pad_corrections += corrections;
  return report;
}

}  // namespace fairing
