// SPDX-License-Identifier: GPL-3.0-or-later
// The couples that fix normals (hold/couples.h), before the rounds that correct them: how a level
// starts with them, and which slopes each makes.
#include <algorithm>

#include "hold/couples.h"
#include "parallel/reductions.h"
#include "thin_plate/solver.h"

namespace fairing {
namespace {

// To what couples are tried out: slopes need no more to be corrected by.
constexpr double trial_tolerance = 0.03;

}  // namespace

// Couples stay what they are as a whole.
void ThinPlateSolver::start_couples(int level) {
  const bool goes_on = level > base_ && has_couples(level - 1);
  if (!goes_on) std::fill(moments_.begin(), moments_.end(), Vec2::Zero());
  if (!has_couples(level)) return;
  if (goes_on) couples_->set_level(grid(level - 1));
  const std::vector<double> before = couples_->totals();
  couples_->set_level(grid(level));
  if (goes_on) couples_->carry(before, moments_);
}

// Couples far apart are tried out in one solve, and others along each axis. How well that goes says
// nothing about the surface, which the smoother is to adapt to.
void ThinPlateSolver::measure_couples(int level) {
  const std::vector<std::vector<std::size_t>> sets = couples_->sets_apart();
  std::vector<Eigen::Matrix2d> slopes(couples_->size(), Eigen::Matrix2d::Zero());
  Array<double> y(3 * grid(level).size());
  PcgLimits rough;
  rough.tolerance = trial_tolerance;
  rough.from_start = true;
  rough.max_iterations = options_.max_iterations;
  const bool adapts = hierarchy_.is_adapting();
  hierarchy_.set_adapting(false);
  const auto each_of = [&](std::size_t first, auto&& visit) {
    for (std::size_t k = first; k < std::min(first + 3, 2 * sets.size()); ++k)
      for (const std::size_t c : sets[k / 2])
        visit(c, Eigen::Index(k - first), Eigen::Index(k % 2));
  };
  for (std::size_t first = 0; first < 2 * sets.size(); first += 3) {
    std::vector<Couple> trials(couples_->size(), Couple::Zero());
    each_of(first,
            [&](std::size_t c, Eigen::Index axis, Eigen::Index k) { trials[c](axis, k) = 1; });
    const auto residual = [&](const double* x, double* r) {
      operators_[std::size_t(level - base_)]->apply(x, r);
      for_each_index(workers_, y.size(), [&](std::size_t i) { r[i] = -r[i]; });
      couples_->add(trials, r);
    };
    for_each_index(workers_, y.size(), [&](std::size_t i) { y[i] = 0; });
    residual(y.data(), hierarchy_.state().residual.data());
    hierarchy_.solve(std::size_t(level - base_), rough, residual, y.data(),
                     [](const PcgResult&) {});
    each_of(first, [&](std::size_t c, Eigen::Index axis, Eigen::Index k) {
      slopes[c].col(k) = couples_->slopes(c, y.data()).row(axis).transpose();
    });
  }
  hierarchy_.set_adapting(adapts);
  couples_->set_compliance(std::move(slopes));
}

}  // namespace fairing
