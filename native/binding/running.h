// SPDX-License-Identifier: GPL-3.0-or-later
// What runs beside Python has to be over before the interpreter ends: a thread that then comes back
// to Python is killed, with our frames on its stack, and takes the process along. So runs say that
// they are on their way, and Python's atexit cancels them and waits. All under Python's lock, which
// is held at a fork, too.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>

#include "parallel/monitor.h"

namespace fairing {

// How long to sleep between two looks at Python: 40 progress calls a second are smooth, and cost
// nothing beside a run.
constexpr std::chrono::milliseconds pause(25);

// What tells a process from its forked children.
long current_process();

// A run is on its way while this exists; the calling thread may let go of Python's lock. Throws
// FairingError(cancelled) where the interpreter is about to end.
class RunningScope {
 public:
  explicit RunningScope(Monitor& monitor);
  ~RunningScope();
  RunningScope(const RunningScope&) = delete;
  RunningScope& operator=(const RunningScope&) = delete;

 private:
  Monitor& monitor_;
  long process_;
  RunningScope *before_ = nullptr, *after_ = nullptr;  // in the list of all
  friend void end_runs();
};

// Has Python's atexit end all runs.
void bind_end();

}  // namespace fairing
