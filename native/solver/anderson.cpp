// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/anderson.h"

#include <Eigen/Dense>

#include "execution/vectors.h"

namespace fairing {
namespace {

constexpr std::size_t depth = 3;
constexpr double regularization = 1e-12;  // of the least squares' diagonal

}  // namespace

void Anderson::reset() {
  pairs_.clear();
  last_.clear();
  gone_.clear();
}

void Anderson::mix(LevelOperator& op, Workers& workers, Array<double>& step) {
  const std::size_t size = step.size();
  if (!last_.empty()) {
    Pair& pair = pairs_.emplace_back();
    pair.change = std::move(last_);
    pair.gone = std::move(gone_);
    for_each_index(workers, size, [&](std::size_t i) { pair.change[i] = step[i] - pair.change[i]; });
    if (pairs_.size() > depth) pairs_.pop_front();
  }
  last_ = step;
  if (!pairs_.empty()) {
    const auto count = Eigen::Index(pairs_.size());
    Eigen::MatrixXd gram(count, count);
    Eigen::VectorXd right(count);
    Array<double> image(size);
    for (Eigen::Index a = 0; a < count; ++a) {
      op.apply(pairs_[std::size_t(a)].change.data(), image.data());
      right(a) = sum(workers, size, [&](std::size_t i) { return image[i] * step[i]; });
      for (Eigen::Index b = 0; b < count; ++b) {
        const Array<double>& other = pairs_[std::size_t(b)].change;
        gram(a, b) = sum(workers, size, [&](std::size_t i) { return image[i] * other[i]; });
      }
    }
    gram.diagonal() *= 1 + regularization;
    const Eigen::VectorXd share = gram.ldlt().solve(right);
    if (share.allFinite())
      for (Eigen::Index a = 0; a < count; ++a) {
        const Pair& pair = pairs_[std::size_t(a)];
        for_each_index(workers, size,
                       [&](std::size_t i) { step[i] -= share(a) * (pair.change[i] + pair.gone[i]); });
      }
  }
  gone_ = step;
}

void Anderson::took(double length) {
  if (length != 1)
    for (double& s : gone_) s *= length;
}

}  // namespace fairing
