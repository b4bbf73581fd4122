// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/hierarchy.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parallel/reductions.h"

namespace fairing {
namespace {

// Solves with a factor, each on the residual of the previous one.
constexpr int refinement_steps = 3;

// Margin of a largest eigenvalue from the level below, where Lanczos' margin is included.
constexpr double settled_margin = 1.03;

// Exchanges two numbers during its lifetime, since a cancelled run throws.
class ScopedExchange {
 public:
  ScopedExchange(int& one, int& other, bool are) : one_(one), other_(are ? other : one) {
    std::swap(one_, other_);
  }
  ~ScopedExchange() { std::swap(one_, other_); }
  ScopedExchange(const ScopedExchange&) = delete;
  ScopedExchange& operator=(const ScopedExchange&) = delete;

 private:
  int &one_, &other_;
};

}  // namespace

Hierarchy::Hierarchy(Workers& workers, const HierarchyOptions& options,
                     const std::vector<HierarchyLevel>& levels)
    : workers_(workers), options_(options), cycle_(workers) {
  const bool is_given = options.smoother_degree > 0;
  cycle_.degree = is_given ? options.smoother_degree : usual_degree;
  degree_of_two_ = is_given ? options.smoother_degree : 2 * usual_degree;
  for (const HierarchyLevel& level : levels) {
    CycleLevel& own = cycle_.levels.emplace_back();
    own.op = &level.op;
    own.transfer = level.to_coarser;
    own.state.resize(level.op.size());
    own.unknowns = level.unknowns;
  }
  std::size_t end = 0;  // the end of the cycle
  while (end + 1 < levels.size() && levels[end + 1].unknowns <= tiny_level) ++end;
  cycle_.coarse = std::make_unique<CoarseSolver>(levels[end].op, workers_, levels[end].unknowns,
                                                 options_.always_factor);
  cycle_.base = end;
  factors_ += cycle_.coarse->direct();
}

// Lines keep their points unless unknowns change. Eigenvalues are derived from those below.
void Hierarchy::update(std::size_t top) {
  int spectrum = 0;
  for (std::size_t l = 0; l <= top; ++l) {
    CycleLevel& level = cycle_.levels[l];
    const OperatorVersion& now = level.op->version();
    if (now.unknowns != level.version.unknowns) level.lines.reset();
    if (level.lines && now.numbers != level.version.numbers) level.lines->refactor();
    if (now.numbers != level.version.numbers) level.work = 0;
    level.version = now;
    spectrum += now.spectrum;
    if (std::exchange(level.spectrum, spectrum) != spectrum) level.largest_eigenvalue = 0;
  }
}

LevelSolve Hierarchy::solve(std::size_t index, const PcgLimits& limits,
                            const LinearSystem& system) {
  LevelSolve out;
  if (index < cycle_.base) {  // below the end of the cycle; met on the way up only
    CoarseSolver solver(*cycle_.levels[index].op, workers_, 0, true);
    solve_direct(solver, limits, system, out);
    return out;
  }
  update(index);
  if (cycle_.coarse->is_old()) {
    cycle_.coarse->refactor();
    ++factors_;
  }
  const bool may_promote = limits.may_adapt && adapts(cycle_.solves(index));
  if (may_promote && is_too_hard(index, limits)) promote_to_coarsest(index);
  if (cycle_.solves(index)) {
    solve_direct(*cycle_.coarse, limits, system, out);
    if (out.converged) return out;
  }
  PcgResult result = iterate(index, limits, system, out);
  if (!result.converged && limits.may_adapt && adapts(out.direct) &&
      (is_too_hard(index, limits) || (result.broke_down && may_factor(index, limits)))) {
    promote_to_coarsest(index);
    solve_direct(*cycle_.coarse, limits, system, out);
    if (out.converged) return out;
    result = conjugate_gradients(cycle_, index, workers_, limits, system, pcg_,
                                 [](const PcgResult&) { return true; });
    out.iterations += result.iterations;
  }
  out.smoother_degree = cycle_.degree;
  out.residual = result.residual;
  out.energy_error = result.energy_error;
  out.largest_eigenvalue = cycle_.levels[index].largest_eigenvalue;
  out.lines = cycle_.levels[index].lines && cycle_.levels[index].lines->serves();
  out.converged = result.converged;
  out.enough = result.enough;
  return out;
}

PcgResult Hierarchy::iterate(std::size_t index, const PcgLimits& limits, const LinearSystem& system,
                             LevelSolve& out) {
  const bool adapt = limits.may_adapt && adapts(out.direct);
  const ScopedExchange degrees(cycle_.degree, degree_of_two_, bool(system.between));
  for (std::size_t l = cycle_.base; l <= index; ++l) seek_lines(l);
  estimate_eigenvalues(index, system.r);
  PcgResult result = conjugate_gradients(cycle_, index, workers_, limits, system, pcg_,
                                         [&](const PcgResult& so_far) {
                                           if (system.watch) system.watch(so_far);
                                           return !adapt || continues(index, so_far, limits);
                                         });
  out.iterations += result.iterations;
  out.residuals = result.history;
  cycle_.levels[index].work += double(result.iterations) * cycle_.degree;
  return result;
}

void Hierarchy::seek_lines(std::size_t index) {
  CycleLevel& level = cycle_.levels[index];
  if (!level.lines && !cycle_.solves(index))
    level.lines = std::make_unique<LineJacobi>(*level.op, workers_);
}

// A residual that remains in spite of a factor may be rounding, which iterations do not reduce.
void Hierarchy::solve_direct(CoarseSolver& solver, const PcgLimits& limits,
                             const LinearSystem& system, LevelSolve& out) {
  const std::size_t size = solver.size();
  double *const x = system.x, *const r = system.r;
  Array<double> step(size);
  out.direct = true;
  out.smoother_degree = 0;
  const double begun = norm(workers_, size, r);
  const double scale = limits.from_start ? begun : limits.residual_scale;
  out.converged = begun <= limits.noise;
  for (int k = 0; k < refinement_steps && !out.converged; ++k) {
    solver.solve(r, step.data());
    for_each_index(workers_, size, [&](std::size_t i) { x[i] += step[i]; });
    system.residual(x, r);
    const double now = norm(workers_, size, r);
    out.residual = limits.relative(now, scale);
    out.converged = out.residual <= limits.tolerance || now <= limits.noise;
  }
  if (!out.converged)
    out.converged = norm(workers_, size, r) <= roundoff_of_terms * solver.norm_of_terms(x);
}

// Whether a level's largest eigenvalue is that of the level below, with a margin. Stencils hardly
// change between levels; but lines become longer, and adjacent to others (on a toroidal tetrahedron
// it rises from 2.9 to 3.7 at level 5).
bool Hierarchy::has_eigenvalue_of_below(std::size_t index) const {
  const CycleLevel& level = cycle_.levels[index];
  return index >= options_.settled && index > cycle_.base && !(level.lines && level.lines->any()) &&
         cycle_.levels[index - 1].largest_eigenvalue > 0;
}

// Lanczos starts with the restricted residual, which rotates and renumbers with the mesh.
void Hierarchy::estimate_eigenvalues(std::size_t top, const double* residual) {
  const auto unknown = [&](std::size_t l) { return cycle_.levels[l].largest_eigenvalue == 0; };
  std::size_t lowest = top + 1;
  while (lowest > cycle_.base && unknown(lowest - 1)) --lowest;
  for (std::size_t l = top; l >= lowest && l <= top; --l) {
    Array<float>& start = cycle_.levels[l].state.residual;
    if (l == top)
      for_each_index(workers_, cycle_.levels[l].op->size(),
                     [&](std::size_t i) { start[i] = float(residual[i]); });
    else
      cycle_.levels[l + 1].transfer->restrict_to(cycle_.levels[l + 1].state.residual.data(),
                                                 start.data());
    if (l == 0) break;
  }
  for (std::size_t l = lowest; l <= top; ++l) {
    CycleLevel& level = cycle_.levels[l];
    if (has_eigenvalue_of_below(l))
      level.largest_eigenvalue = settled_margin * cycle_.levels[l - 1].largest_eigenvalue;
    else
      level.largest_eigenvalue =
          largest_eigenvalue(*level.op, level.lines.get(), workers_, level.state.residual.data());
  }
}

}  // namespace fairing
