// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/anderson.h"

#include <Eigen/Dense>

#include "parallel/reductions.h"

namespace fairing {
namespace {

// Steps that are remembered: each costs an application of the operator and two vectors.
constexpr std::size_t depth = 3;
// Of the least squares' diagonal: steps near the end may be linearly dependent.
constexpr double regularization = 1e-12;

}  // namespace

void Anderson::reset() {
  pairs_.clear();
  last_step_.clear();
  last_movement_.clear();
}

void Anderson::accelerate(LevelOperator& op, Workers& workers, Array<double>& step) {
  const std::size_t size = step.size();
  if (!last_step_.empty()) {
    Pair& pair = pairs_.emplace_back();
    pair.step_change = std::move(last_step_);
    pair.movement = std::move(last_movement_);
    for_each_index(workers, size,
                   [&](std::size_t i) { pair.step_change[i] = step[i] - pair.step_change[i]; });
    if (pairs_.size() > depth) pairs_.pop_front();
  }
  last_step_ = step;
  if (!pairs_.empty()) {
    const auto count = Eigen::Index(pairs_.size());
    Eigen::MatrixXd gram(count, count);
    Eigen::VectorXd right(count);
    Array<double> product(size);
    for (Eigen::Index a = 0; a < count; ++a) {
      op.apply(pairs_[std::size_t(a)].step_change.data(), product.data());
      right(a) = sum(workers, size, [&](std::size_t i) { return product[i] * step[i]; });
      for (Eigen::Index b = 0; b < count; ++b) {
        const Array<double>& other = pairs_[std::size_t(b)].step_change;
        gram(a, b) = sum(workers, size, [&](std::size_t i) { return product[i] * other[i]; });
      }
    }
    gram.diagonal() *= 1 + regularization;
    const Eigen::VectorXd share = gram.ldlt().solve(right);
    if (share.allFinite())
      for (Eigen::Index a = 0; a < count; ++a) {
        const Pair& pair = pairs_[std::size_t(a)];
        for_each_index(workers, size, [&](std::size_t i) {
          step[i] -= share(a) * (pair.step_change[i] + pair.movement[i]);
        });
      }
  }
  last_movement_ = step;
}

void Anderson::accept(double length) {
  if (length != 1)
    for (double& s : last_movement_) s *= length;
}

}  // namespace fairing
