// SPDX-License-Identifier: GPL-3.0-or-later
// Runs must be over before the interpreter ends: it kills a thread that returns to Python later,
// with our frames on its stack, and the process with it. So runs are registered, and Python's
// atexit cancels them and waits. All under Python's lock, which is also held during a fork.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>

#include "parallel/monitor.h"

namespace fairing {

// Sleep between two checks of Python: 40 progress calls a second are smooth, and cost nothing
// beside a run.
constexpr std::chrono::milliseconds pause(25);

// Identifies the process; its forked children differ.
long current_process();

// Registers a run during its lifetime; the calling thread may release Python's lock. Throws
// FairingError(cancelled) while the interpreter is ending.
class RunningScope {
 public:
  explicit RunningScope(Monitor& monitor);
  ~RunningScope();
  RunningScope(const RunningScope&) = delete;
  RunningScope& operator=(const RunningScope&) = delete;

 private:
  Monitor& monitor_;
  long process_;
  RunningScope *before_ = nullptr, *after_ = nullptr;  // in the list of all runs
  friend void end_runs();
};

// Lets Python's atexit end all runs.
void bind_end();

}  // namespace fairing
