// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates the distance to the solution from the decrements of the last two steps: with their
// ratio q, the remaining steps are q + q^2 + ... = q / (1 - q) times the last one.
#pragma once

#include <algorithm>

namespace fairing {

class ErrorEstimate {
 public:
  // `least_ratio`: share of the error that the solve of a step leaves. Acceleration and inexact
  // solves make the measured ratio too small, so smaller ratios are replaced by this one (measured:
  // without it the steps of one sphere of a hundred end too early, with it none's).
  explicit ErrorEstimate(double least_ratio) : least_ratio_(least_ratio) {}

  // Call it after a step with this decrement, whose full length would have moved points by at most
  // `movement`. If it is not `solved`, its ratio counts as one.
  double after(double decrement, double movement, bool solved) {
    const double ratio = last_ > 0 && solved && has_ratio_ ? decrement / last_ : 1;
    const double trusted = std::clamp(ratio, least_ratio_, most_ratio);
    has_ratio_ = last_ > 0;
    last_ = decrement;
    return trusted / (1 - trusted) * movement;
  }

  // Call it after a rejected step; the next one starts a new sequence.
  void forget() {
    last_ = 0;
    has_ratio_ = false;
  }

  // 0: no step yet
  double last_decrement() const { return last_; }

 private:
  // Larger ratios are replaced by this one, so that the estimate never exceeds the last step. It
  // also serves after the first two steps, as the first is not accelerated and so makes their ratio
  // too small.
  static constexpr double most_ratio = 0.5;

  double least_ratio_, last_ = 0;
  bool has_ratio_ = false;  // whether the previous step had a ratio
};

}  // namespace fairing
