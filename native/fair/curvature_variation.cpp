// SPDX-License-Identifier: GPL-3.0-or-later
// The steps from the least total curvature to the least variation of curvature.
#include <cmath>
#include <utility>

#include "execution/vectors.h"
#include "fair/curvature.h"

namespace fairing {
namespace {

constexpr std::size_t wide_rows = 4;  // 37 numbers in place of 19: a factor costs so many times as much

constexpr double enough = 1e-3, late_enough = 3e-2;  // decrements
constexpr int patience = 10;                         // steps, after which the second will do
constexpr double slack = 0.1, late = 1e-3;           // as those of curvature_steps.cpp
constexpr double least_share = 1e-6;                 // of the damping: of the energies' ratio
constexpr double still = 1e-4;                       // of the curvature: variation that is as good as none

}  // namespace

// From the surface of least total curvature to that of least variation of curvature, by Levenberg-Marquardt steps: the
// matrix of total curvature, which knows no long waves that cost nothing, damps them.
void CurvatureSystem::vary(int level, CurvatureLevelReport& report) {
  double square = 0, area = 0;  // total curvature, and the area
  const std::size_t points = lattice(level).size();
  const auto measure = [&](const Array<float>& shape) {
    square = sum(workers_, points, [&](std::size_t i) {
      const float* m = &shape[4 * i];
      return double(m[3]) * m[3] * (double(m[0]) * m[0] + double(m[1]) * m[1] + double(m[2]) * m[2]);
    });
    area = sum(workers_, points, [&](std::size_t i) { return double(shape[4 * i + 3]) * shape[4 * i + 3]; });
  };
  measure(here_.shape);
  if (!(square > flat)) return;
  shared_.energy = CurvatureEnergy::minimum_variation;
  shared_.damping = 0;
  hierarchy_.set_factor_price(wide_rows);
  here_.with_axes = there_.with_axes = true;
  energy_ = op(level).linearize(surface_.data(), &here_);
  report.start_variation = energy_;
  report.converged = false;
  LocalDamping damping(lattice(level), shared_.unknowns, workers_);
  int rejections = 0;
  double last = 0;  // decrement
  for (int steps = 0; steps < options_.max_steps && rejections < most_rejections; ++steps) {
    report_progress(level, report);
    // near a sphere nothing varies: what is left of the energy is measured by the curvature itself
    const double scale = energy_ + still * square / area;
    shared_.damping = damping_share_ * scale / square;
    const bool fresh = !std::exchange(is_near_, false) && is_fresh(last);
    if (fresh) linearize_below(level);
    for (int l = fresh ? level : base_; l <= level; ++l) op(l).update_diagonal();
    damp(level, damping.mu());
    StepReport& step = report.steps.emplace_back();
    step.variation = true;
    step.energy = energy_;
    const double reduction = solve_step(level, step, fresh);
    step.decrement = std::sqrt(reduction / scale);
    op(level).predict(here_.shape, step_.data(), predicted_);
    bool accepted = false;
    for (step.length = 1; step.length >= least_length && !accepted; step.length /= 2) {
      const double energy = try_step(level, step.length);
      if (step.length == 1)
        damping.judge(predicted_, here_, there_, rejections, steps - rejections, step.decrement);
      if (!(energy <= energy_ + slack * step.decrement * scale) && !(step.decrement < late)) continue;
      const double gain = reduction > 0 ? (energy_ - energy) / reduction : 1;
      std::swap(surface_, trial_);
      std::swap(here_, there_);
      energy_ = energy;
      accepted = true;
      if (step.length < 1)
        damping_share_ *= 2;
      else if (gain > 0.5)
        damping_share_ = std::max(damping_share_ / 4, least_share);
      break;
    }
    if (!accepted) {
      step.length = 0;
      damping_share_ = std::max(4 * damping_share_, first_damping_share);
      ++rejections;
      last = 0;
      op(level).linearize(surface_.data(), &here_);
      continue;
    }
    last = step.decrement;
    measure(here_.shape);
    step.movement = step.length * largest(workers_, points, [&](std::size_t i) { return step_[i]; });
    report.converged = step.decrement <= (steps < patience ? enough : late_enough) ||
                       step.movement <= options_.step_tolerance;
    report.accurate = step.movement <= options_.step_tolerance;
    if (report.converged) break;
  }
  report.variation = energy_;
  shared_.energy = CurvatureEnergy::total_curvature;
  shared_.damping = 0;
  hierarchy_.set_factor_price(1);
}

}  // namespace fairing
