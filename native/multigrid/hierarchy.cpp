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

// An iteration with the diagonal that gains less, as a logarithm, is slow: it takes more than 18 to
// 1e-4, where even meshes take five to ten. Blocks serve better then, with this degree to begin
// with. Odd degrees gain less than the even ones below them.
constexpr double slow_gain = 0.5;
constexpr int degree_of_blocks = 2;
// With more, blocks cost more than what they are there for.
constexpr int most_degree_of_blocks = 8;

// Solves with a factor, each on the residual that the one before has left.
constexpr int refinement_steps = 3;

// Iterations after which a factor that is of another K is made anew.
constexpr int most_with_old_factor = 20;
// Unknowns up to which a level is factored whenever its K is another: iterations cost as much.
constexpr std::size_t most_refactored = 4 * tiny_level;

// Of the products' terms: what rounding may leave of the residual.
constexpr double rounding = 2e-15;

// On a largest eigenvalue that is taken from the level below. Lanczos' own margin is in that one.
constexpr double settled_margin = 1.03;

// Numbers a column of a narrow level's factor; that of a plate has some 80.
constexpr std::size_t most_numbers_of_narrow = 20;

// Of a level larger than direct_limit_of_hard that is factored nevertheless: half of what one of that
// size takes on an even mesh.
constexpr std::size_t most_factor_numbers = 50 * direct_limit_of_hard;

// The smoother's degree from which on factoring a level is cheaper than smoothing it: it grows with
// what a factor costs, and above hopeless_degree a factor is cheaper whatever it costs (without
// that, minimum variation of Suzanne went on for minutes).
constexpr int least_degree_of_hard = 8;
constexpr std::size_t hopeless_degree = 60;
int degree_of_hard(std::size_t unknowns, bool is_cheap, std::size_t price) {
  const std::size_t dear = is_cheap ? unknowns / 5000 : price * unknowns / 1000;
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
  pace_.emplace_back();
}

void Hierarchy::complete() {
  std::size_t end = 0;  // of the cycle
  while (end + 1 < unknowns_.size() && unknowns_[end + 1] <= tiny_level) ++end;
  coarse_ = std::make_unique<CoarseSolver>(*cycle_.levels[end].op, workers_, unknowns_[end],
                                           options_.always_factor);
  cycle_.coarse = coarse_.get();
  cycle_.base = end;
  factors_ += coarse_->direct();
  pcg_.residual.resize(cycle_.levels.back().op->size());
}

void Hierarchy::refresh(std::size_t top, bool spectrum) {
  if (coarse_->direct() && top >= cycle_.base) refactor();
  for (std::size_t l = 0; l <= top; ++l)
    if (cycle_.levels[l].blocks && !cycle_.levels[l].blocks->refactor()) leave_blocks();
  if (spectrum)
    for (std::size_t l = 0; l <= top; ++l) cycle_.levels[l].largest_eigenvalue = 0;
}

void Hierarchy::refresh_lazily(std::size_t top, bool fresh) {
  if (top == cycle_.base && coarse_->direct() && (!fresh || unknowns_[top] > most_refactored))
    is_factor_old_ = true;
  else if (fresh)
    refresh(top, true);
}

void Hierarchy::refactor() {
  coarse_->refactor();
  is_factor_old_ = false;
  ++factors_;
}

LevelSolve Hierarchy::solve(std::size_t index, const PcgLimits& limits, const Residual& residual,
                            double* x, const std::function<void(const PcgResult&)>& each) {
  LevelSolve out;
  if (index < cycle_.base) {  // beyond the cycle's end; met on the way up only
    CoarseSolver solver(*cycle_.levels[index].op, workers_, 0, true);
    solve_direct(solver, limits, residual, x, out);
    return out;
  }
  if (index == cycle_.base && coarse_->direct()) {
    if (is_factor_old_ && solve_by_old_factor(limits, residual, x, out)) return out;
    if (is_factor_old_) refactor();
    solve_direct(*coarse_, limits, residual, x, out);
    if (out.converged) return out;
  }
  PcgResult result = iterate(index, limits, residual, x, each, out);
  if (!result.converged && adapts(out.direct) && is_too_hard(index)) {
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
  out.blocks = cycle_.levels[index].blocks != nullptr;
  out.converged = result.converged;
  out.enough = result.enough;
  return out;
}

// A narrow level, as a disc of thin faces about one vertex, has a factor of few numbers however large
// it is; the factor of the level below tells.
bool Hierarchy::knows_factor_below(std::size_t index) const {
  return index == cycle_.base + 1 && coarse_->direct();
}

bool Hierarchy::may_factor(std::size_t index) const {
  if (unknowns_[index] <= direct_limit_of_hard) return true;
  if (!knows_factor_below(index)) return false;
  const double growth =
      double(unknowns_[index]) / double(std::max<std::size_t>(unknowns_[index - 1], 1));
  return growth * double(coarse_->factor_numbers()) <= double(most_factor_numbers);
}

bool Hierarchy::factors_cheaply(std::size_t index) const {
  return unknowns_[index] <= options_.cheap_factor ||
         (knows_factor_below(index) &&
          coarse_->factor_numbers() <= most_numbers_of_narrow * unknowns_[index - 1]);
}

// Conjugate gradients, once more where the smoother takes blocks on the way; to the end, or until
// the level is too hard.
PcgResult Hierarchy::iterate(std::size_t index, const PcgLimits& limits, const Residual& residual,
                             double* x, const std::function<void(const PcgResult&)>& each,
                             LevelSolve& out) {
  const bool adapt = adapts(out.direct);
  PcgLimits rest = limits;
  if (options_.operators_change) pace_[index] = {};
  for (;;) {
    if (adapt && wants_blocks(index, pace_[index])) take_blocks(index);
    estimate_eigenvalues(index);
    PcgResult result = conjugate_gradients(
        cycle_, index, workers_, rest, residual, pcg_, x, [&](const PcgResult& so_far) {
          each(so_far);
          if (adapt && wants_blocks(index, pace_[index].after(so_far, rest.from_start)))
            return false;
          if (adapt && so_far.iterations % probe_interval == first_probe)
            raise_degree(index, so_far, limits.tolerance);
          if (adapt && blocks_fail(index)) return false;
          return !adapt || !is_too_hard(index);
        });
    if (adapt) pace_[index] = pace_[index].after(result, rest.from_start);
    out.iterations += result.iterations;
    const bool first = out.residuals.empty();
    out.residuals.insert(out.residuals.end(), result.history.begin() + (first ? 0 : 1),
                         result.history.end());
    rest.max_iterations -= result.iterations;
    if (!adapt || result.converged || rest.max_iterations <= 0) return result;
    if (blocks_fail(index)) {
      options_.may_block = false;
      leave_blocks();
    } else if (!wants_blocks(index, pace_[index])) {
      return result;
    }
    rest.from_start = false;
    rest.residual_scale = result.residual_scale;
    rest.energy_scale = result.energy_scale;
  }
}

Hierarchy::Pace Hierarchy::Pace::after(const PcgResult& result, bool from_start) const {
  const double last = result.history.back();
  double gain = last > 0 ? std::log(result.history.front() / last) : 0.0;
  if (from_start && result.energy_error > 0) gain = std::max(gain, -std::log(result.energy_error));
  return {iterations + result.iterations, gained + gain};
}

bool Hierarchy::is_too_hard(std::size_t index) const {
  return may_factor(index) && MemoryLedger::fits(factor_price_ * factor_bytes(unknowns_[index])) &&
         cycle_.degree >= degree_of_hard(unknowns_[index], factors_cheaply(index), factor_price_);
}

// Skew makes a mesh hard on all levels alike: where the one below has blocks, this one needs them.
bool Hierarchy::wants_blocks(std::size_t index, const Pace& pace) const {
  if (!options_.may_block || !blocks_allowed_ || cycle_.levels[index].blocks) return false;
  if (options_.operators_change && factors_cheaply(index)) return false;
  return (index > 0 && cycle_.levels[index - 1].blocks) || is_too_hard(index) ||
         (pace.iterations >= first_probe && pace.gained < slow_gain * pace.iterations);
}

// Where a factor may follow, and blocks want as many steps as the diagonal.
bool Hierarchy::blocks_fail(std::size_t index) const {
  return options_.operators_change && cycle_.levels[index].blocks &&
         cycle_.degree > most_degree_of_blocks;
}

void Hierarchy::take_blocks(std::size_t index) {
  for (std::size_t l = cycle_.base; l <= index && options_.may_block; ++l) {
    CycleLevel& level = cycle_.levels[l];
    if (level.blocks || (l == cycle_.base && coarse_->direct())) continue;
    level.blocks = BlockJacobi::make(*level.op, workers_);
    level.largest_eigenvalue = 0;
    options_.may_block = level.blocks != nullptr;
  }
  if (options_.may_block) cycle_.degree = degree_of_blocks;
}

void Hierarchy::allow_blocks(bool allowed) {
  blocks_allowed_ = allowed;
  if (!allowed) leave_blocks();
}

// What wanted blocks is hard: it is factored next, if it may be.
void Hierarchy::leave_blocks() {
  for (std::size_t l = 0; l < cycle_.levels.size(); ++l) {
    CycleLevel& level = cycle_.levels[l];
    if (!level.blocks) continue;
    level.blocks.reset();
    level.largest_eigenvalue = 0;
    cycle_.degree = may_factor(l) ? degree_of_hard(unknowns_[l], factors_cheaply(l), factor_price_)
                                  : VCycle::usual_degree;
  }
}

bool Hierarchy::solve_by_old_factor(const PcgLimits& limits, const Residual& residual, double* x,
                                    LevelSolve& out) {
  PcgLimits few = limits;
  few.max_iterations = std::min(limits.max_iterations, most_with_old_factor);
  const PcgResult result = conjugate_gradients(cycle_, cycle_.base, workers_, few, residual, pcg_,
                                               x, [](const PcgResult&) { return true; });
  out.direct = true;
  out.smoother_degree = 0;
  out.iterations = result.iterations;
  out.residual = result.residual;
  out.converged = result.converged;
  return out.converged;
}

// Where the factor's trace keeps it from K, once more with less of one. What is then left in spite of
// a factor may be rounding, of which iterations make no less.
void Hierarchy::solve_direct(CoarseSolver& solver, const PcgLimits& limits,
                             const Residual& residual, double* x, LevelSolve& out) {
  const std::size_t size = solver.size();
  Array<double>& r = pcg_.residual;
  Array<double> step(size);
  out.direct = true;
  out.smoother_degree = 0;
  const double scale = limits.from_start ? norm(workers_, size, r.data()) : limits.residual_scale;
  const auto refine = [&] {
    for (int k = 0; k < refinement_steps && !out.converged; ++k) {
      solver.solve(r.data(), step.data());
      for_each_index(workers_, size, [&](std::size_t i) { x[i] += step[i]; });
      residual(x, r.data());
      const double now = norm(workers_, size, r.data());
      out.residual = scale > 0 ? now / scale : 0;
      out.converged = out.residual <= limits.tolerance || now <= limits.noise;
    }
  };
  refine();
  if (!out.converged && solver.lessen_trace()) refine();
  if (!out.converged)
    out.converged = norm(workers_, size, r.data()) <= rounding * solver.norm_of_terms(x);
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
    if (below > 0 && l >= options_.settled && !level.blocks)
      level.largest_eigenvalue = settled_margin * below;
    else
      level.largest_eigenvalue =
          largest_eigenvalue(*level.op, level.blocks.get(), workers_, level.state.residual.data());
  }
}

// From here on this level is the coarsest, solved directly.
void Hierarchy::promote_to_coarsest(std::size_t index) {
  coarse_ = std::make_unique<CoarseSolver>(*cycle_.levels[index].op, workers_, 0, true);
  is_factor_old_ = false;
  ++factors_;
  cycle_.coarse = coarse_.get();
  cycle_.base = index;
  cycle_.degree = std::min(cycle_.degree, most_degree_over_factor);
}

// What the iterations so far have gained tells how hard the mesh is; the smoother's degree follows,
// so that the rest takes few iterations. (Iterations times degree, the work, hardly changes.)
void Hierarchy::raise_degree(std::size_t index, const PcgResult& result, double tolerance) {
  // The first iterations are the easy ones; the latest tell more.
  const int window = std::min(result.iterations, probe_interval);
  const double gained =
      std::log(result.history[result.history.size() - 1 - std::size_t(window)] / result.residual);
  const double missing =
      std::log(std::max(result.residual / tolerance, result.energy_error / tolerance));
  const double ahead = gained > 0 ? window * missing / gained : 10.0 * iterations_wanted;
  if (ahead <= iterations_wanted) return;
  int degree = int(std::ceil(cycle_.degree * std::min(most_rise, ahead / iterations_wanted)));
  if (cycle_.levels[index].blocks) degree += degree % 2;
  cycle_.degree = std::min(degree, most_degree);
}

void Hierarchy::choose_degree(const LevelSolve& last, double tolerance, double next_tolerance) {
  if (!adapts(last.direct) || last.blocks || last.iterations < 4) return;
  const double ahead = last.iterations * std::log(next_tolerance) / std::log(tolerance);
  const double wanted =
      last.smoother_degree * std::min(most_rise_between_levels, ahead / iterations_wanted);
  cycle_.degree = std::clamp(int(std::ceil(wanted)), cycle_.degree, most_degree);
}

}  // namespace fairing
