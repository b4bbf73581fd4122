// SPDX-License-Identifier: GPL-3.0-or-later
// Anderson's acceleration of steps that each leave a fixed share of the error [Anderson 1965;
// Walker and Ni 2011]: the last few steps reveal that share. With the changes dF_k of the steps and
// dx_k of the iterate, a step f becomes
//
//   f - sum_k c_k (dF_k + dx_k),
//
// where c minimizes the norm of f - sum_k c_k dF_k. On linear problems it is GMRES.
#pragma once

#include <Eigen/Dense>
#include <deque>
#include <utility>

#include "base/roundoff.h"

namespace fairing {

// `Space` provides the vectors and their norm:
//
//   Vector product(const Vector& a)                                     the norm's matrix times a
//   double dot(const Vector& a, const Vector& b)
//   void add(double factor, const Vector& a, const Vector& b, Vector& to)   to += factor (a + b)
//   void subtract(const Vector& a, Vector& from)
template <class Space>
class Anderson {
 public:
  using Vector = typename Space::Vector;

  // Remembers `depth` steps; each costs a product and two vectors.
  Anderson(Space space, std::size_t depth) : space_(std::move(space)), depth_(depth) {}

  // The change of the iterate, from this step and the last few.
  Vector change(const Vector& step);
  // Call it if this share of the last change() was made.
  void took_share(double share) { space_.scale(share, last_change_); }
  // Makes the next step the first one.
  void forget() {
    pairs_.clear();
    any_ = false;
  }

 private:
  struct Pair {
    Vector step_change, iterate_change;  // dF and dx
  };
  Space space_;
  std::size_t depth_;
  std::deque<Pair> pairs_;
  bool any_ = false;
  Vector last_, last_change_;
};

template <class Space>
typename Space::Vector Anderson<Space>::change(const Vector& step) {
  if (any_) {
    Pair pair{step, std::move(last_change_)};
    space_.subtract(last_, pair.step_change);
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
      const Vector product = space_.product(pairs_[a].step_change);
      right(a) = space_.dot(product, step);
      for (Eigen::Index b = 0; b < count; ++b)
        gram(a, b) = space_.dot(product, pairs_[b].step_change);
    }
    gram.diagonal() *= 1 + roundoff;  // steps near the end may be linearly dependent
    const Eigen::VectorXd share = gram.ldlt().solve(right);
    if (share.allFinite())
      for (Eigen::Index a = 0; a < count; ++a) {
        const Pair& pair = pairs_[a];
        space_.add(-share(a), pair.step_change, pair.iterate_change, out);
      }
  }
  last_change_ = out;
  return out;
}

}  // namespace fairing
