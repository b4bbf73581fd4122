// SPDX-License-Identifier: GPL-3.0-or-later
// Gauss-Newton steps on one level.
#include <cmath>
#include <utility>

#include "execution/vectors.h"
#include "fair/curvature.h"
#include "lattice/sample.h"

namespace fairing {
namespace {

constexpr double inner_accuracy = 1e-2;  // of the linear solves: a step gains no more

// The energy of a right step may rise a little near the end, where the discrete energy's minimum lies beside the
// solution of the equation; nearer still it does not tell any more.
constexpr double slack = 0.1;  // times the decrement
constexpr double late = 1e-2;  // decrement

constexpr double accelerated = 0.1;  // decrement below which steps are accelerated
constexpr double first_ratio = 10;   // times the first ratio of decrements, which flatters
constexpr double least_ratio = 0.1;  // that is believed: accelerated steps, of inexact solves, flatter too
constexpr double regular = 0.5;      // ratio of decrements below which they tell what is left

constexpr double steps_begin = 0.3, steps_end = 0.85;  // of the run

}  // namespace

void CurvatureSystem::linearize_below(int level) {
  const Array<double>* from = &surface_;
  Array<double> coarse[2];
  for (int l = level - 1; l >= base_; --l) {
    monitor_.check_cancelled();
    Array<double>& to = coarse[l % 2];
    to.resize(3 * lattice(l).size());
    sample<3>(lattice(l), lattice(l + 1), workers_, from->data(), to.data());
    op(l).linearize(to.data());
    from = &to;
  }
}

void CurvatureSystem::damp(int level, const Array<float>& mu) {
  op(level).set_damping(mu);
  if (mu.empty()) return;
  Array<float> fine = mu, coarse;
  for (int l = level - 1; l >= base_; --l) {
    coarse.resize(lattice(l).size());
    sample<1>(lattice(l), lattice(l + 1), workers_, fine.data(), coarse.data());
    op(l).set_damping(coarse);
    fine.swap(coarse);
  }
}

void CurvatureSystem::minimize(int level, Mode mode, const Enough& enough, int patience,
                               CurvatureLevelReport& report) {
  LocalDamping damping(lattice(level), shared_.unknowns, workers_);
  go_steps(level, mode == Mode::damped ? &damping : nullptr, enough, options_.max_steps, patience, report);
}

void CurvatureSystem::go_steps(int level, LocalDamping* damping, const Enough& enough, int most, int patience,
                               CurvatureLevelReport& report) {
  const Array<float> undamped;
  anderson_.reset();
  trial_.resize(3 * lattice(level).size());
  here_.with_axes = there_.with_axes = damping != nullptr;  // what local damping compares in
  if (!is_linearized_) energy_ = op(level).linearize(surface_.data(), &here_);
  is_linearized_ = false;
  int rejections = 0;
  double last = 0;
  bool last_but_one = false;
  for (int steps = 0; steps < most && rejections < most_rejections; ++steps) {
    if ((report.converged = energy_ < flat)) break;
    report_progress(level, report);
    const bool fresh = damping || (!std::exchange(is_near_, false) && is_fresh(last));
    if (fresh) linearize_below(level);
    damp(level, damping ? damping->mu() : undamped);
    StepReport& step = report.steps.emplace_back();
    step.energy = energy_;
    step.decrement = std::sqrt(solve_step(level, step, fresh) / energy_);
    if (!advance(level, step, damping, rejections, steps - rejections)) {
      if (!damping) break;
      ++rejections;
      last = 0;
      continue;
    }
    // Steps gain by a ratio that the last two tell, and with it what is left.
    const double ratio = last > 0 ? step.decrement / last : 1;
    const double trusted = std::max(least_ratio, ratio * (last_but_one ? 1 : first_ratio));
    const double ahead = trusted < regular ? trusted / (1 - trusted) : 1;
    last_but_one = last > 0;
    last = step.decrement;
    if (hold_.adapts() && !shared_.weights.empty()) {
      adapt_hold(level);
      last = 0;
    }
    report.converged =
        enough.decrement > 0 ? step.decrement <= enough.decrement : ahead * step.movement <= enough.movement;
    report.accurate = ahead * step.movement <= options_.step_tolerance;
    report.converged &= shared_.weights.empty() || !hold_.adapts() || hold_.holds(surface_);
    if (report.converged) break;
    if (!damping && steps + 1 >= patience && step.decrement > plain_decrement) break;
  }
  report.energy = op(level).bending();
}

// Nobody knows how many steps there will be; most runs take four.
void CurvatureSystem::report_progress(int level, const CurvatureLevelReport& report) {
  monitor_.check_cancelled();
  if (level + 1 < int(lattices_.size())) return;
  const double steps = double(report.steps.size());
  monitor_.report(Phase::solve, steps_begin + (steps_end - steps_begin) * steps / (steps + 4));
}

// The step h of K h = force, in step_; `fresh`: coarse levels, or the surface by much, have changed. Returns h . K h, by which it would lower the energy.
double CurvatureSystem::solve_step(int level, StepReport& report, bool fresh) {
  const std::size_t points = lattice(level).size(), index = std::size_t(level - base_);
  step_.assign(points, 0.0);
  if (fresh) hierarchy_.refresh(index, true);
  PcgState& state = hierarchy_.state();
  std::copy(here_.force.begin(), here_.force.end(), state.residual.begin());
  PcgLimits limits;
  limits.tolerance = inner_accuracy;
  limits.from_start = true;
  limits.max_iterations = options_.max_iterations;
  const LevelSolve solved = hierarchy_.solve(index, limits, step_.data(), [](const PcgResult&) {});
  report.iterations = solved.iterations;
  report.residual = solved.residual;
  report.direct = solved.direct;
  for (const Mirror* mirror : mirrors_)
    mean_of_displacements(lattice(level), *mirror, shared_.unknowns, workers_, step_.data());
  const double square = sum(workers_, points, [&](std::size_t i) { return here_.force[i] * step_[i]; });
  return std::max(0.0, square);
}

// Goes along step_ as far as the energy allows; false: nowhere.
bool CurvatureSystem::advance(int level, StepReport& step, LocalDamping* damping, int rejections, int steps) {
  if (step.decrement < accelerated) anderson_.mix(op(level), workers_, step_);
  if (damping) op(level).predict(here_.shape, step_.data(), predicted_);
  const bool is_late = !damping || step.decrement < late;
  for (step.length = 1; step.length >= least_length; step.length /= 2) {
    const double energy = try_step(level, step.length);
    step.movement = step.length * largest(workers_, step_.size(), [&](std::size_t i) { return step_[i]; });
    if (step.length == 1 && !is_late &&
        damping->judge(predicted_, here_, there_, rejections, steps, step.decrement))
      anderson_.reset();
    if (!std::isfinite(energy) || (!is_late && energy > energy_ * (1 + slack * step.decrement))) continue;
    anderson_.took(step.length);
    std::swap(surface_, trial_);
    std::swap(here_, there_);
    energy_ = energy;
    return true;
  }
  step.length = 0;
  anderson_.reset();
  op(level).linearize(surface_.data(), &here_);
  return false;
}

double CurvatureSystem::try_step(int level, double length) {
  for_each_index(workers_, surface_.size(),
                 [&](std::size_t i) { trial_[i] = surface_[i] + length * step_[i / 3] * here_.normal[i]; });
  symmetrize(level, trial_);
  return op(level).linearize(trial_.data(), &there_);
}

}  // namespace fairing
