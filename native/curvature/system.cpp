// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/system.h"

#include <algorithm>
#include <utility>

#include "grid/injection.h"
#include "parallel/reductions.h"
#include "sparse/unknown_points.h"

namespace fairing {
namespace {

// Relative to the first residual. More accuracy saves no outer step, or at most one.
constexpr double inner_accuracy = 1e-2;
// Most iterations of a solve for minimum variation. The next step corrects the rest; a step with an
// unfinished solve does not count as the last one (error_estimate.h).
constexpr int most_of_variation = 24;

constexpr double progress_begin = 0.3, progress_end = 0.85;  // shares of the whole run

HierarchyOptions hierarchy_options(const Unknowns& unknowns, const GaussNewtonOptions& options) {
  HierarchyOptions out;
  out.smoother_degree = options.solve.smoother_degree;
  out.always_factor = unknowns.any_vertex;
  out.hard_levels = HardLevels::factored;
  // As for the thin plate, the area's share of the diagonal falls from level to level.
  if (options.tension > 0) ++out.settled;
  return out;
}

}  // namespace

GaussNewtonSystem::GaussNewtonSystem(const ControlMesh& mesh, const GridLevels& grids, int base,
                                     const Stencils& stencils, const Unknowns& unknowns,
                                     const GaussNewtonOptions& options,
                                     IntervalConstraints* constraints, Symmetry symmetry,
                                     Workers& workers, Monitor& monitor)
    : stencils_(stencils),
      base_(base),
      options_(options),
      monitor_(monitor),
      grids_(grids),
      shared_{mesh, unknowns, workers},
      symmetry_(std::move(symmetry)),
      constraints_(constraints) {
  shared_.tension = options.tension;
  shared_.ends_in_variation = options.energy == CurvatureEnergy::minimum_variation;
  shared_.refined = finest() > 0;
  std::vector<HierarchyLevel> all;
  for (int l = base; l <= finest(); ++l) {
    operators_.push_back(std::make_unique<CurvatureLevel>(shared_, grid(l)));
    if (l > 0)
      transfers_.push_back(std::make_unique<QuadraticTransfer<1>>(
          grid(l - 1), grid(l), stencils, shared_.unknowns, workers, shared_.float_slots));
    all.push_back({*operators_.back(), l > base ? transfers_.back().get() : nullptr,
                   count_unknowns(grid(l), unknowns)});
  }
  hierarchy_ = std::make_unique<Hierarchy>(workers, hierarchy_options(unknowns, options), all);
}

GaussNewtonSystem::~GaussNewtonSystem() = default;

void GaussNewtonSystem::linearize(int level, LinearizedSurface& surface) {
  surface.energy =
      op(level).linearize(surface.points.data(), surface.functional, &surface.linearization);
  surface.version = op(level).linearizations();
}

void GaussNewtonSystem::penalize(int level, Reference reference, LinearizedSurface& surface) {
  if (reference.points.empty()) return;
  op(level).penalize(std::move(reference), surface.points.data(), surface.linearization);
  surface.energy = op(level).objective();
}

void GaussNewtonSystem::linearize_below(int level, const LinearizedSurface& about) {
  op(level).spectrum_changed();
  Functional in_cycles;  // of total curvature
  in_cycles.in_cycles = op(level).varies();
  const Array<double>* fine = &about.points;
  Array<double> buffer[2];
  for (int l = level - 1; l >= base_; --l) {
    monitor_.check_cancelled();
    Array<double>& coarse = buffer[l % 2];
    coarse.resize(3 * grid(l).size());
    inject<3>(grid(l), grid(l + 1), workers(), fine->data(), coarse.data());
    op(l).linearize(coarse.data(), in_cycles);
    op(l).spectrum_changed();
    fine = &coarse;
  }
}

void GaussNewtonSystem::set_damping(int level, const Array<float>& mu, double share) {
  Array<float> here = mu, below;
  for (int l = level; l >= base_; --l) {
    op(l).set_damping(here, l == level ? share : 0);
    if (op(level).varies()) here.clear();
    if (here.empty() || l == base_) continue;
    below.resize(grid(l - 1).size());
    inject<1>(grid(l - 1), grid(l), workers(), here.data(), below.data());
    here.swap(below);
  }
}

// A tenth of an energy that is mostly the penalty's would tell nothing of broad faces.
PcgLimits GaussNewtonSystem::limits(int level, const Functional& functional) const {
  PcgLimits limits;
  const bool loads_change = functional.pads && !constraints_;
  const bool varies = functional.energy == CurvatureEnergy::minimum_variation;
  limits.tolerance = loads_change || (varies && !op(level).penalty()) ? inexact : inner_accuracy;
  limits.from_start = true;
  limits.by_error = loads_change;
  limits.may_end_early = varies;
  limits.max_iterations = options_.solve.max_iterations;
  if (varies) limits.max_iterations = std::min(limits.max_iterations, most_of_variation);
  return limits;
}

double GaussNewtonSystem::solve(int level, const LinearizedSurface& about, Array<double>& h,
                                Multipliers<1>& held, StepReport& report) {
  const std::size_t points = grid(level).size(), index = std::size_t(level - base_);
  const Functional& functional = about.functional;
  h.assign(points, 0.0);
  if (constraints_) {
    linearize_about(about, held);
    set_weights(level);
  }
  LevelSolve solved;
  Array<double> constraint_force;  // force of loads and springs
  const Array<double>& force = about.linearization.force;
  if (functional.pads || constraints_) {
    solved = solve_held(level, about, h, held, constraint_force, report);
  } else {
    Array<double> left = force;
    const auto residual = [&](const double* x, double* r) {
      op(level).apply(x, r);
      for_each_index(workers(), points, [&](std::size_t i) { r[i] = force[i] - r[i]; });
    };
    LinearSystem k{residual, h.data(), left.data()};
    if (op(level).varies())
      k.between = [&](const float* y, float* z) { op(level).apply_between(y, z); };
    solved = hierarchy_->solve(index, limits(level, about.functional), k);
    report.iterations = solved.iterations;
  }
  report.residual = solved.residual;
  report.solved = solved.converged;
  report.direct = solved.direct;
  ++work_.steps;
  work_.iterations += report.iterations;
  work_.pad_corrections += report.pad_corrections;
  symmetrize_displacements(grid(level), symmetry_, shared_.unknowns, workers(), h.data());
  report.load_work = sum(workers(), constraint_force.size(),
                         [&](std::size_t i) { return constraint_force[i] * h[i]; });
  return report.load_work + sum(workers(), points, [&](std::size_t i) { return force[i] * h[i]; });
}

StepWork GaussNewtonSystem::work(int level) const {
  StepWork out = work_;
  out.linearizations = op(level).linearizations();
  out.factors = hierarchy_->factors();
  return out;
}

void GaussNewtonSystem::report_progress(int level, std::size_t steps) {
  monitor_.check_cancelled();
  if (level < finest()) return;
  // The number of steps is unknown.
  const double share = double(steps) / double(steps + 1);
  monitor_.report(Phase::solve, progress_begin + (progress_end - progress_begin) * share);
}

void SurfaceIterate::ensure_linearized(const Functional& functional) {
  if (current.version != op().linearizations() || !(current.functional == functional))
    linearize(functional);
}

double SurfaceIterate::try_step(double length) {
  for_each_index(workers(), current.points.size(), [&](std::size_t i) {
    trial.points[i] = current.points[i] + length * step[i / 3] * current.linearization.normal[i];
  });
  system.symmetrize(level, trial.points);
  trial.functional = current.functional;
  system.linearize(level, trial);
  return trial.energy;
}

double SurfaceIterate::movement(double length) {
  return length * largest(workers(), step.size(), [&](std::size_t i) { return step[i]; });
}

bool SurfaceIterate::needs_coarse_levels(double last_decrement) {
  if (std::exchange(is_near_earlier, false)) return false;
  return !(last_decrement > 0 && last_decrement < settling_decrement);
}

}  // namespace fairing
