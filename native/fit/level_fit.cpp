// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/level_fit.h"

#include <cmath>

#include "parallel/reductions.h"
#include "sparse/unknown_points.h"

namespace fairing {

LevelFit::LevelFit(const FitProblem& problem, int level)
    : problem_(problem),
      level_(level),
      cells_(problem.levels.grid(level), problem.levels.workers()),
      finder_(cells_, problem.scan, 2 * problem.edge, problem.levels.workers()),
      sums_(cells_, problem.levels.workers()),
      unknown_(unknown_points(problem.levels.grid(level), problem.levels.shared().unknowns)) {}

void LevelFit::set_surface(Array<double> x) {
  x_ = std::move(x);
  finder_.set_surface(x_.data());
  finder_.find(feet_);
  update_spread();
}

void LevelFit::set_surface(Array<double> x, Array<Foot> feet) {
  x_ = std::move(x);
  feet_ = std::move(feet);
  finder_.set_surface(x_.data());
  finder_.follow(feet_);
}

double LevelFit::stiffest() const {
  const double shortest = std::max(problem_.edge / cells_.grid().n(), apart());
  return std::max(1.0, std::pow(problem_.edge / shortest, 4));
}

void LevelFit::iterate(double weight, int count, bool robust) {
  for (int k = 0; k < count; ++k) {
    problem_.monitor.check_cancelled();
    compute_forces(weight, robust);
    solve();
    finder_.set_surface(x_.data());
    finder_.follow(feet_);
  }
  update_spread();
}

void LevelFit::update_spread() {
  spread_ = spread_of(feet_, trained_);
  spread_.rms = std::max(spread_.rms, least_noise * problem_.edge);
}

// Computes weight_, and right_side_ <- W x + forces, the right-hand side of the solve.
void LevelFit::compute_forces(double weight, bool robust) {
  Workers& workers = problem_.levels.workers();
  update_spread();
  robust_weight_.resize(feet_.size());
  for_each_index(workers, feet_.size(), [&](std::size_t s) {
    const bool counts = trained_.empty() || trained_[s];
    const double share =
        share_.empty() || !feet_[s].is_used() ? 1 : share_[cells_.face(feet_[s].cell)];
    // where points act less the surface leaves them: they are not outliers
    const bool doubted = robust && share == 1;
    robust_weight_[s] =
        counts ? float(doubted ? robust_weight(double(feet_[s].offset), spread_.rms) : share)
               : 0.0f;
  });
  sums_.sum(finder_, feet_, robust_weight_, weight_, force_);
  const double scale =
      spread_.count ? weight * problem_.unit * problem_.area / double(spread_.count) : 0;
  right_side_.resize(x_.size());
  for_each_index(workers, unknown_.size(), [&](std::size_t p) {
    const double own = unknown_[p] ? scale * weight_[p] : 0,
                 held = unknown_[p] && !prior_.weight.empty() ? prior_.weight[p] : 0;
    for (std::size_t a = 0; a < 3; ++a)
      right_side_[3 * p + a] = (unknown_[p] ? scale * force_[p][a] : 0) + own * x_[3 * p + a] +
                               (held > 0 ? held * prior_.place[3 * p + a] : 0);
    weight_[p] = own + held;
  });
}

void LevelFit::solve() {
  ThinPlateLevels& levels = problem_.levels;
  Workers& workers = levels.workers();
  VertexWeights weights = std::move(weight_);
  for (int l = level_; l >= levels.base(); --l) {
    VertexWeights below;
    if (l > levels.base()) below = weights_below(levels.grid(l), levels.grid(l - 1), weights);
    levels.set_point_weights(std::move(weights), l);
    weights = std::move(below);
  }
  const auto residual = [&](const double* x, double* r) {
    levels.op(level_).apply(x, r);
    for_each_index(workers, x_.size(), [&](std::size_t i) { r[i] = right_side_[i] - r[i]; });
  };
  r_.resize(x_.size());
  residual(x_.data(), r_.data());
  const Array<float>& inverse = levels.op(level_).inverse_diagonal();
  const double terms = std::sqrt(sum(workers, x_.size(), [&](std::size_t i) {
    const double t = unknown_[i / 3] ? x_[i] / double(inverse[i / 3]) : 0;
    return t * t;
  }));
  PcgLimits limits;
  limits.tolerance = difference_tolerance;
  limits.from_start = true;
  limits.noise = roundoff_of_terms * terms;
  limits.may_end_early = true;  // the next iteration continues
  limits.max_iterations = problem_.most_iterations;
  iterations_ += levels.solve(level_, limits, {residual, x_.data(), r_.data()}).iterations;
}

}  // namespace fairing
