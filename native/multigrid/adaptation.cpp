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

// Most numbers a column in the factor of a narrow level; that of a plate has some 80.
constexpr std::size_t most_numbers_of_narrow = 20;

// Most numbers in the factor of a level above direct_limit_of_hard: half of those of a level of
// this size on an even mesh.
constexpr std::size_t most_factor_numbers = 50 * direct_limit_of_hard;

// The smoother's degree from which factoring a level costs less than smoothing it. It grows with
// the cost of the factor; from most_degree_of_hard on any factor costs less.
constexpr int least_degree_of_hard = 8;
constexpr std::size_t most_degree_of_hard = 60;  // for a factor of 52,000 unknowns
int degree_of_hard(std::size_t unknowns, bool is_cheap) {
  const std::size_t for_its_size = is_cheap ? unknowns / 5000 : unknowns / 1000;
  return int(std::min<std::size_t>(least_degree_of_hard + for_its_size, most_degree_of_hard));
}

}  // namespace

// A narrow level, such as a disc of thin faces around one vertex, has a factor with few numbers at
// any size; the factor of the level below shows it.
bool Hierarchy::knows_factor_below(std::size_t index) const {
  return index == cycle_.base + 1 && cycle_.coarse->direct();
}

bool Hierarchy::may_factor(std::size_t index, const PcgLimits& limits) const {
  if (limits.may_end_early) return false;
  if (unknowns(index) <= direct_limit_of_hard) return true;
  if (!knows_factor_below(index)) return false;
  const double growth =
      double(unknowns(index)) / double(std::max<std::size_t>(unknowns(index - 1), 1));
  return growth * double(cycle_.coarse->factor_numbers()) <= double(most_factor_numbers);
}

bool Hierarchy::factors_cheaply(std::size_t index) const {
  return unknowns(index) <= options_.cheap_factor ||
         (knows_factor_below(index) &&
          cycle_.coarse->factor_numbers() <= most_numbers_of_narrow * unknowns(index - 1));
}

bool Hierarchy::continues(std::size_t index, const PcgResult& so_far, const PcgLimits& limits) {
  if (so_far.iterations % probe_interval == first_probe) raise_degree(so_far, limits);
  return !is_too_hard(index, limits);
}

bool Hierarchy::fits_factor(std::size_t index, const PcgLimits& limits) const {
  return may_factor(index, limits) && MemoryLedger::fits(factor_bytes(unknowns(index)));
}

// A factor only saves time here. Its matrix needs up to half as much memory again.
bool Hierarchy::is_too_hard(std::size_t index, const PcgLimits& limits) const {
  return fits_factor(index, limits) && is_expected_memory(3 * factor_bytes(unknowns(index)) / 2) &&
         cycle_.degree >= degree_of_hard(unknowns(index), factors_cheaply(index));
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
