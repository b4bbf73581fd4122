// SPDX-License-Identifier: GPL-3.0-or-later
// Progress and cancellation through atomics: the run never calls foreign code.
#pragma once

#include <atomic>
#include <cstdint>

#include "base/error.h"

namespace fairing {

enum class Phase : int {
  check,
  hierarchy,
  curves,
  solve,
  constrain,
  measure,
  output,
  patches,
  done
};

inline const char* name(Phase phase) {
  switch (phase) {
    case Phase::check: return "check";
    case Phase::hierarchy: return "hierarchy";
    case Phase::curves: return "curves";
    case Phase::solve: return "solve";
    case Phase::constrain: return "constrain";
    case Phase::measure: return "measure";
    case Phase::output: return "output";
    case Phase::patches: return "patches";
    case Phase::done: return "done";
  }
  return "";
}

// Shared between a run and its observers, on any thread.
class Monitor {
 public:
  void cancel() { wish_.store(Wish::stop, std::memory_order_relaxed); }
  // Cancels at the n-th check: tests can stop a run at any check, repeatably.
  void cancel_at_question(std::int64_t n) {
    questions_.store(n, std::memory_order_relaxed);
    wish_.store(Wish::count, std::memory_order_relaxed);
  }
  double fraction() const { return fraction_.load(std::memory_order_relaxed); }
  Phase phase() const { return phase_.load(std::memory_order_relaxed); }

  // For the run: sets its progress; throws FairingError(cancelled) if requested.
  void report(Phase phase, double fraction) {
    fraction = begin_ + (end_ - begin_) * fraction;
    phase_.store(phase, std::memory_order_relaxed);
    // Only the run's thread writes; progress never decreases.
    if (fraction > fraction_.load(std::memory_order_relaxed))
      fraction_.store(fraction, std::memory_order_relaxed);
    check_cancelled();
  }
  // For the run's thread: later fractions are parts of [begin, end] of the whole.
  void enter_part(double begin, double end) {
    begin_ = begin;
    end_ = end;
  }
  void check_cancelled() const {
    if (wish_.load(std::memory_order_relaxed) != Wish::go_on) answer();
  }

 private:
  enum class Wish : int { go_on, count, stop };

  void answer() const {
    if (wish_.load(std::memory_order_relaxed) == Wish::count &&
        questions_.fetch_sub(1, std::memory_order_relaxed) > 1)
      return;
    throw FairingError(ErrorCode::cancelled, "Cancelled.");
  }

  std::atomic<Wish> wish_{Wish::go_on};
  mutable std::atomic<std::int64_t> questions_{0};
  std::atomic<double> fraction_{0.0};
  std::atomic<Phase> phase_{Phase::check};
  double begin_ = 0, end_ = 1;
};

}  // namespace fairing
