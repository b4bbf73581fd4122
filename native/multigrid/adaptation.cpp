// SPDX-License-Identifier: GPL-3.0-or-later
// Adaptation of a hierarchy: degree of the smoother, and factors.
#include <algorithm>
#include <cmath>

#include "multigrid/hierarchy.h"
#include "parallel/expected_memory.h"

namespace fairing {
namespace {

// Iterations before the smoother's degree is judged: at first, and from then on.
constexpr int first_probe = 6, probe_interval = 10;
// Number of iterations that should remain after a change: so few that conjugate gradients and their
// sums cost little beside the smoother, whose work hardly depends on the degree.
constexpr double iterations_wanted = 14;
// Largest rise of the degree at one probe, as a factor, and largest degree.
constexpr double most_rise = 8;
constexpr int most_degree = 96;  // steps before, and after, coarser levels
// Largest factor between the degree at the end of a level and at the begin of the next.
constexpr double most_rise_between_levels = 2;
// After a level has become the coarsest, which removes the hardest part.
constexpr int most_degree_over_factor = 12;

// The smoother's degree from which factoring a small level costs less than smoothing it.
constexpr std::size_t least_degree_of_hard = 8;
// A factor's time grows faster than the level: for so many more unknowns, one degree more.
constexpr std::size_t unknowns_per_degree = 2500;

}  // namespace

bool Hierarchy::continues(std::size_t index, const PcgResult& so_far, const PcgLimits& limits) {
  if (so_far.iterations % probe_interval == first_probe) raise_degree(so_far, limits);
  return !is_too_hard(index, limits);
}

bool Hierarchy::may_factor(std::size_t index, const PcgLimits& limits) const {
  const std::size_t bytes = factor_bytes(unknowns(index));
  return options_.hard_levels != HardLevels::smoothed && !limits.may_end_early &&
         unknowns(index) <= direct_limit_of_hard && MemoryLedger::fits(bytes) &&
         is_expected_memory(3 * bytes / 2);  // with its matrix
}

// By the degree that a solve needs; or where earlier solves of the same system have together cost as
// much as a factor, so that a level is never smoothed for much longer than that.
bool Hierarchy::is_too_hard(std::size_t index, const PcgLimits& limits) const {
  if (!may_factor(index, limits)) return false;
  const bool expected = options_.hard_levels == HardLevels::expected;
  if (expected && (unknowns(index) <= direct_limit || is_above_hard(index))) return true;
  const double degree =
      std::max<double>(cycle_.degree, cycle_.levels[index].work / iterations_wanted);
  return degree >= double(least_degree_of_hard + unknowns(index) / unknowns_per_degree);
}

// Whether the level below was factored after a trial.
bool Hierarchy::is_above_hard(std::size_t index) const {
  return cycle_.base + 1 == index && unknowns(cycle_.base) > direct_limit;
}

// Makes this level the coarsest, solved directly.
void Hierarchy::promote_to_coarsest(std::size_t index) {
  cycle_.coarse =
      std::make_unique<CoarseSolver>(*cycle_.levels[index].op, workers_, unknowns(index), true);
  ++factors_;
  cycle_.base = index;
  cycle_.degree = std::min(cycle_.degree, most_degree_over_factor);
}

// Raises the smoother's degree by the gain of the iterations so far, which shows how hard the mesh
// is, so that few iterations remain. (The work, iterations times degree, hardly changes.)
void Hierarchy::raise_degree(const PcgResult& result, const PcgLimits& limits) {
  const int window = std::min(result.iterations, probe_interval);
  const auto gain_of = [&](const std::vector<double>& norms) {
    const std::size_t back = std::min(norms.size(), std::size_t(window) + 1);
    return std::log(norms[norms.size() - back] / norms.back());
  };
  double gained = gain_of(result.history);
  // Beside faces much smaller than others residuals rise at first while the error falls.
  if (gained <= 0) gained = gain_of(result.seen);
  const double missing =
      std::log(std::max(result.residual, result.energy_error) / limits.tolerance);
  const double ahead = gained > 0 ? window * missing / gained : 10.0 * iterations_wanted;
  if (ahead <= iterations_wanted) return;
  const int degree = int(std::ceil(cycle_.degree * std::min(most_rise, ahead / iterations_wanted)));
  cycle_.degree = std::min(degree, limits.may_end_early ? most_degree_over_factor : most_degree);
}

// Harder meshes need a larger degree than the usual one. If a single iteration gained more than a
// whole solve should, the degree is lowered, at most by half, where conjugate gradients cost as
// much as the smoother. A raised degree is kept.
void Hierarchy::choose_degree(const LevelSolve& last, double tolerance, double next_tolerance,
                              double solve_gain) {
  if (!adapts(last.direct) || last.iterations == 0) return;
  const double ahead = last.iterations * std::log(next_tolerance) / std::log(tolerance);
  const double for_iterations =
      last.smoother_degree * std::min(most_rise_between_levels, ahead / iterations_wanted);
  const double for_gain = std::min<double>(
      last.smoother_degree * last.iterations * std::log(solve_gain) / std::log(tolerance),
      usual_degree);
  const int least = cycle_.degree > usual_degree ? cycle_.degree : usual_degree / 2;
  cycle_.degree =
      std::clamp(int(std::ceil(std::max(for_iterations, for_gain))), least, most_degree);
}

}  // namespace fairing
