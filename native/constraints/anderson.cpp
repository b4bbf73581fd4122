// SPDX-License-Identifier: GPL-3.0-or-later
#include "constraints/anderson.h"

#include <Eigen/Dense>
#include <utility>

#include "base/roundoff.h"

namespace fairing {

Anderson::Vector Anderson::change(const Vector& step) {
  if (any_) {
    Pair pair{step, std::move(last_change_)};
    for (std::size_t i = 0; i < step.size(); ++i) pair.step_change[i] -= last_[i];
    pairs_.push_back(std::move(pair));
    if (pairs_.size() > depth_) pairs_.pop_front();
  }
  any_ = true;
  last_ = step;
  Vector out = step;
  if (!pairs_.empty()) {
    const auto count = Eigen::Index(pairs_.size());
    Eigen::MatrixXd gram(count, count);
    Eigen::VectorXd right(count);
    for (Eigen::Index a = 0; a < count; ++a) {
      const Vector product = product_(pairs_[a].step_change);
      right(a) = dot_(product.size(), product, step);
      for (Eigen::Index b = 0; b < count; ++b)
        gram(a, b) = dot_(product.size(), product, pairs_[b].step_change);
    }
    gram.diagonal() *= 1 + roundoff;  // steps near the end may be linearly dependent
    const Eigen::VectorXd share = gram.ldlt().solve(right);
    if (share.allFinite())
      for (Eigen::Index a = 0; a < count; ++a) {
        const auto& [step_change, iterate_change] = pairs_[a];
        for (std::size_t i = 0; i < out.size(); ++i)
          out[i] += -share(a) * (step_change[i] + iterate_change[i]);
      }
  }
  last_change_ = out;
  return out;
}

}  // namespace fairing
