// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>

#include "execution/monitor.h"
#include "fair/report.h"

namespace fairing {

// Seconds a phase; a phase that comes again is added to.
class Stopwatch {
 public:
  Stopwatch(Report& report, Monitor& monitor) : report_(report), monitor_(monitor) {}

  void enter(Phase phase, double fraction) {
    leave();
    phase_ = phase;
    monitor_.report(phase, fraction);
  }
  void leave() {
    const auto now = std::chrono::steady_clock::now();
    if (running_) add(name(phase_), std::chrono::duration<double>(now - start_).count());
    start_ = now;
    running_ = true;
  }

 private:
  void add(const char* phase, double seconds) {
    for (auto& entry : report_.seconds)
      if (entry.phase == phase) {
        entry.seconds += seconds;
        return;
      }
    report_.seconds.push_back({phase, seconds});
  }

  Report& report_;
  Monitor& monitor_;
  Phase phase_ = Phase::check;
  bool running_ = false;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace fairing
