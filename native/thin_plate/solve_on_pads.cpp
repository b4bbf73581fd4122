// SPDX-License-Identifier: GPL-3.0-or-later
// The plate on pads: loads and surface in turn (hold/load_steps.h).
#include <algorithm>
#include <cmath>

#include "hold/load_steps.h"
#include "parallel/reductions.h"
#include "thin_plate/solver.h"

namespace fairing {
namespace {

// Each solve but the last leaves so much of the error that it finds: loads gain little more.
constexpr double solve_gain = 0.1;
// What a correction leaves of the forces, before two of them have said it.
constexpr double first_ratio = 0.3;
// Of the corrections to the loads: below the finest level they are starts only.
constexpr double coarse_force_tolerance = 2e-2;
constexpr double aim = 0.5;  // of the tolerance: what a last correction is to come to
constexpr int most_corrections = 16;

// A force on a control vertex that is one part in a hundred of the needle's leaves one part in a
// hundred of its spot, which nobody sees; who asks for an exact surface gets exact loads.
double force_tolerance(double relative_residual) {
  return std::clamp(10 * std::sqrt(relative_residual), 1e-6, 1e-2);
}

}  // namespace

// r <- Omega phi f - K x on the unknowns; the forces left at the control vertices apart.
void ThinPlateSolver::residual_on_pads(int level, const double* x, double* r) {
  apply_thin_plate(grid(level), shared_.double_rows, pads_->rows(), {}, workers_,
                   shared_.double_slots, x, r);
  for_each_index(workers_, 3 * grid(level).size(), [&](std::size_t i) { r[i] = -r[i]; });
  pads_->add_loads(loads_, r);
  take_forces<3>(*pads_, -1, r, forces_);
}

// Loads are densities and hardly change from level to level; what does is the hats' samples.
void ThinPlateSolver::start_loads(int level) {
  loads_.resize(std::size_t(mesh_.vertex_count()));
  if (level == base_) {
    std::fill(loads_.begin(), loads_.end(), Vec3::Zero());
    return;
  }
  pads_->set_level(grid(level - 1));
  for (std::size_t v = 0; v < loads_.size(); ++v) loads_[v] *= pads_->total(v);
  pads_->set_level(grid(level));
  for (std::size_t v = 0; v < loads_.size(); ++v)
    if (pads_->under(v)) loads_[v] /= pads_->total(v);
}

LevelReport ThinPlateSolver::solve_on_pads(int level, const PcgLimits& limits, double* x) {
  pads_->set_level(grid(level));
  Array<double>& r = hierarchy_.state().residual;
  forces_.assign(loads_.size(), Vec3::Zero());
  const bool keeps_forces = operators_[std::size_t(level - base_)]->single_precision_suffices();
  const double wanted =
      level < top() ? coarse_force_tolerance : force_tolerance(options_.relative_residual);
  LoadSteps<3> steps(*pads_);
  Loads correction, product;
  LevelReport report;
  double before = 0, ratio = first_ratio, gain = 0;
  bool whole = false;  // whether the solve goes as far as is asked
  residual_on_pads(level, x, r.data());
  for (;;) {
    PcgLimits now = limits;
    now.from_start = !whole && !limits.from_start;
    if (now.from_start) now.tolerance = std::max(limits.tolerance, solve_gain);
    const LevelSolve solve = hierarchy_.solve(
        std::size_t(level - base_), now,
        [&](const double* y, double* left) { residual_on_pads(level, y, left); }, x,
        [&](const PcgResult& so_far) {
          if (whole) report_progress(level, so_far, limits.tolerance);
        });
    const int iterations = report.iterations + solve.iterations;
    static_cast<LevelSolve&>(report) = solve;
    report.iterations = iterations;
    if (solve.iterations > 0 && solve.residuals.back() > 0)
      gain += std::log(solve.residuals.front() / solve.residuals.back());
    if (!solve.direct && !keeps_forces) residual_on_pads(level, x, r.data());

    pads_->divide_by_mass<3>(forces_, correction);
    pads_->multiply_mass<3>(loads_, product);
    const double left = std::sqrt(std::max(0.0, dot<3>(correction, forces_))),
                 size = std::sqrt(std::max(0.0, dot<3>(loads_, product)));
    report.pad_force = size > 0 ? left / size : left > 0 ? 1.0 : 0.0;
    double force_norm = 0;
    for (const Vec3& f : forces_) force_norm += f.squaredNorm();
    const bool settled =
        report.pad_force <= wanted ||
        std::sqrt(force_norm) <= std::max(limits.noise, limits.tolerance * limits.residual_scale);
    if (whole && (settled || report.pad_corrections >= most_corrections)) {
      report.converged = report.converged && settled;
      break;
    }
    if (before > 0 && left > 0) ratio = std::clamp(left / before, 0.05, 1.0);
    before = left;
    whole = whole || settled || ratio * report.pad_force <= aim * wanted ||
            report.pad_corrections + 1 >= most_corrections;
    if (!settled) {
      const Loads change = steps.change(correction);
      for (std::size_t v = 0; v < loads_.size(); ++v) loads_[v] += change[v];
      ++report.pad_corrections;
    }
    residual_on_pads(level, x, r.data());
  }
  pace_ = report;
  if (gain > 0) pace_.iterations = int(-report.iterations * std::log(limits.tolerance) / gain);
  report.level = level;
  report.points = grid(level).size();
  report.unknowns = count_unknowns(grid(level), shared_.unknowns);
  return report;
}

}  // namespace fairing
