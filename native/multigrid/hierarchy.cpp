// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/hierarchy.h"

#include <algorithm>
#include <cmath>

#include "parallel/reductions.h"

namespace fairing {
namespace {

// Iterations after which the smoother's degree is thought over: the first time, and from then on.
constexpr int first_probe = 6, probe_interval = 10;
// So many iterations are to remain after that: few enough that conjugate gradients and their sums
// cost little beside the smoother, whose work hardly changes with the degree.
constexpr double iterations_wanted = 14;
// Of one probe, and of all.
constexpr double most_rise = 8;
constexpr int most_degree = 96;
// What a level's first solve may raise of the degree that the level below ended with.
constexpr double most_rise_between_levels = 2;
// After a level has become the coarsest, which takes the hardest part away.
constexpr int most_degree_over_factor = 12;

// Solves with a factor, each on the residual that the one before has left.
constexpr int refinement_steps = 3;

// On a largest eigenvalue that is taken from the level below. Lanczos' own margin is in that one.
constexpr double settled_margin = 1.03;

// Of a level larger than direct_limit_of_hard that is factored nevertheless: half of what one of that
// size takes on an even mesh.
constexpr std::size_t most_factor_numbers = 50 * direct_limit_of_hard;

// The smoother's degree from which on factoring a level is cheaper than smoothing it: it grows with
// what a factor costs, and above hopeless_degree a factor is cheaper whatever it costs (without
// that, minimum variation of Suzanne went on for minutes).
constexpr int least_degree_of_hard = 8;
constexpr std::size_t hopeless_degree = 60;
int degree_of_hard(std::size_t unknowns, std::size_t cheap, std::size_t price) {
  const std::size_t dear = unknowns <= cheap ? unknowns / 5000 : price * unknowns / 1000;
  return int(std::min<std::size_t>(least_degree_of_hard + dear, hopeless_degree));
}

}  // namespace

Hierarchy::Hierarchy(Workers& workers, const HierarchyOptions& options)
    : workers_(workers), options_(options), cycle_(workers) {
  if (options.smoother_degree > 0) cycle_.degree = options.smoother_degree;
}

void Hierarchy::add(LevelOperator& op, LevelTransfer* to_coarser, std::size_t unknowns) {
  CycleLevel level;
  level.op = &op;
  level.transfer = to_coarser;
  level.state.resize(op.size());
  cycle_.levels.push_back(std::move(level));
  unknowns_.push_back(unknowns);
}

void Hierarchy::complete() {
  std::size_t end = 0;  // of the cycle
  while (end + 1 < unknowns_.size() && unknowns_[end + 1] <= tiny_level) ++end;
  coarse_ = std::make_unique<CoarseSolver>(*cycle_.levels[end].op, workers_, unknowns_[end],
                                           options_.always_factor);
  cycle_.coarse = coarse_.get();
  cycle_.base = end;
  pcg_.residual.resize(cycle_.levels.back().op->size());
}

void Hierarchy::refresh(std::size_t top, bool spectrum) {
  if (coarse_->direct() && top >= cycle_.base) coarse_->refactor();
  if (spectrum)
    for (std::size_t l = 0; l <= top; ++l) cycle_.levels[l].largest_eigenvalue = 0;
}

LevelSolve Hierarchy::solve(std::size_t index, const PcgLimits& limits, const Residual& residual,
                            double* x, const std::function<void(const PcgResult&)>& each) {
  LevelSolve out;
  if (index < cycle_.base) {  // beyond the cycle's end; met on the way up only
    const CoarseSolver solver(*cycle_.levels[index].op, workers_, 0, true);
    solve_direct(solver, limits, residual, x, out);
    return out;
  }
  if (index == cycle_.base && coarse_->direct()) {
    solve_direct(*coarse_, limits, residual, x, out);
    if (out.converged) return out;
  }
  estimate_eigenvalues(index);
  const bool adapt = adapts(out.direct);
  const bool may_factor = adapt &&
                          (unknowns_[index] <= direct_limit_of_hard || factors_cheaply(index)) &&
                          MemoryLedger::fits(factor_bytes(unknowns_[index]));
  const auto too_hard = [&] {
    return may_factor &&
           cycle_.degree >= degree_of_hard(unknowns_[index], options_.cheap_factor, factor_price_);
  };
  PcgResult result = conjugate_gradients(
      cycle_, index, workers_, limits, residual, pcg_, x, [&](const PcgResult& so_far) {
        each(so_far);
        if (adapt && so_far.iterations % probe_interval == first_probe)
          raise_degree(so_far, limits.tolerance);
        return !too_hard();
      });
  out.iterations = result.iterations;
  out.residuals = result.history;
  if (!result.converged && too_hard()) {
    promote_to_coarsest(index);
    solve_direct(*coarse_, limits, residual, x, out);
    if (out.converged) return out;
    result = conjugate_gradients(cycle_, index, workers_, limits, residual, pcg_, x,
                                 [](const PcgResult&) { return true; });
    out.iterations += result.iterations;
  }
  out.smoother_degree = cycle_.degree;
  out.residual = result.residual;
  out.energy_error = result.energy_error;
  out.largest_eigenvalue = cycle_.levels[index].largest_eigenvalue;
  out.converged = result.converged;
  return out;
}

// A narrow level, as a disc of thin faces about one vertex, has a factor of few numbers however large
// it is; the factor of the level below tells.
bool Hierarchy::factors_cheaply(std::size_t index) const {
  if (index != cycle_.base + 1 || !coarse_->direct()) return false;
  const double growth =
      double(unknowns_[index]) / double(std::max<std::size_t>(unknowns_[index - 1], 1));
  return growth * double(coarse_->factor_numbers()) <= double(most_factor_numbers);
}

void Hierarchy::solve_direct(const CoarseSolver& solver, const PcgLimits& limits,
                             const Residual& residual, double* x, LevelSolve& out) {
  const std::size_t size = solver.size();
  Array<double>& r = pcg_.residual;
  Array<double> step(size);
  out.direct = true;
  out.smoother_degree = 0;
  const double scale = limits.from_start ? norm(workers_, size, r.data()) : limits.residual_scale;
  for (int k = 0; k < refinement_steps && !out.converged; ++k) {
    solver.solve(r.data(), step.data());
    for_each_index(workers_, size, [&](std::size_t i) { x[i] += step[i]; });
    residual(x, r.data());
    const double now = norm(workers_, size, r.data());
    out.residual = scale > 0 ? now / scale : 0;
    out.converged = out.residual <= limits.tolerance || now <= limits.noise;
  }
}

// Stencils hardly change from level to level, and from some fineness on the spectrum's upper end
// neither. Each level's Lanczos iteration starts from the residual, restricted: that turns and
// renumbers with the mesh.
void Hierarchy::estimate_eigenvalues(std::size_t top) {
  const auto unknown = [&](std::size_t l) { return cycle_.levels[l].largest_eigenvalue == 0; };
  std::size_t lowest = top + 1;
  while (lowest > cycle_.base && unknown(lowest - 1)) --lowest;
  for (std::size_t l = top; l >= lowest && l <= top; --l) {
    Array<float>& start = cycle_.levels[l].state.residual;
    if (l == top)
      for_each_index(workers_, cycle_.levels[l].op->size(),
                     [&](std::size_t i) { start[i] = float(pcg_.residual[i]); });
    else
      cycle_.levels[l + 1].transfer->restrict_to(cycle_.levels[l + 1].state.residual.data(),
                                                 start.data());
    if (l == 0) break;
  }
  for (std::size_t l = lowest; l <= top; ++l) {
    CycleLevel& level = cycle_.levels[l];
    const double below = l > cycle_.base ? cycle_.levels[l - 1].largest_eigenvalue : 0;
    if (below > 0 && l >= options_.settled)
      level.largest_eigenvalue = settled_margin * below;
    else
      level.largest_eigenvalue =
          largest_eigenvalue(*level.op, workers_, level.state.residual.data());
  }
}

// From here on this level is the coarsest, solved directly.
void Hierarchy::promote_to_coarsest(std::size_t index) {
  coarse_ = std::make_unique<CoarseSolver>(*cycle_.levels[index].op, workers_, 0, true);
  cycle_.coarse = coarse_.get();
  cycle_.base = index;
  cycle_.degree = std::min(cycle_.degree, most_degree_over_factor);
}

// What the iterations so far have gained tells how hard the mesh is; the smoother's degree follows,
// so that the rest takes few iterations. (Iterations times degree, the work, hardly changes.)
void Hierarchy::raise_degree(const PcgResult& result, double tolerance) {
  // The first iterations are the easy ones; the latest tell more.
  const int window = std::min(result.iterations, probe_interval);
  const double gained =
      std::log(result.history[result.history.size() - 1 - std::size_t(window)] / result.residual);
  const double missing =
      std::log(std::max(result.residual / tolerance, result.energy_error / tolerance));
  const double ahead = gained > 0 ? window * missing / gained : 10.0 * iterations_wanted;
  if (ahead <= iterations_wanted) return;
  cycle_.degree = std::min(
      most_degree, int(std::ceil(cycle_.degree * std::min(most_rise, ahead / iterations_wanted))));
}

void Hierarchy::choose_degree(const LevelSolve& last, double tolerance, double next_tolerance) {
  if (!adapts(last.direct) || last.iterations < 4) return;
  const double ahead = last.iterations * std::log(next_tolerance) / std::log(tolerance);
  const double wanted =
      last.smoother_degree * std::min(most_rise_between_levels, ahead / iterations_wanted);
  cycle_.degree = std::clamp(int(std::ceil(wanted)), cycle_.degree, most_degree);
}

}  // namespace fairing
