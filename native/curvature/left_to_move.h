// SPDX-License-Identifier: GPL-3.0-or-later
// How far steps still have to go, as the decrements of the last two of them tell: for a ratio q the
// steps to come are q + q^2 + ... = q / (1 - q) of the last one.
#pragma once

#include <algorithm>

namespace fairing {

class LeftToMove {
 public:
  // `least_ratio`: what the solve of a step leaves of its error. Acceleration and inexact solves
  // flatter, wherefore no smaller ratio is believed (measured: with it no sphere of a hundred is left
  // too early, without it one is).
  explicit LeftToMove(double least_ratio) : least_ratio_(least_ratio) {}

  // After a step of this decrement that would have moved no point farther than `movement`. One that
  // is not `solved` leaves as much as it has found.
  double after(double decrement, double movement, bool solved) {
    const double ratio = last_ > 0 && solved && has_ratio_ ? decrement / last_ : 1;
    const double trusted = std::clamp(ratio, least_ratio_, most_ratio);
    has_ratio_ = last_ > 0;
    last_ = decrement;
    return trusted / (1 - trusted) * movement;
  }

  // After a step that was not taken: the next one begins a new sequence.
  void forget() {
    last_ = 0;
    has_ratio_ = false;
  }

  // 0: there was no step.
  double last_decrement() const { return last_; }

 private:
  // None above is believed, or a single step would be told to leave more than itself. The first
  // ratio is of a step that was not accelerated, which flatters: it counts as this.
  static constexpr double most_ratio = 0.5;

  double least_ratio_, last_ = 0;
  bool has_ratio_ = false;  // whether the step before had one
};

}  // namespace fairing
