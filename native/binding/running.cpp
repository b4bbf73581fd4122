// SPDX-License-Identifier: GPL-3.0-or-later
#include "binding/running.h"

#include <thread>
#include <utility>

#if !defined(_WIN32)
#include <unistd.h>
#endif

namespace py = pybind11;

namespace fairing {
namespace {

// The list of all runs of `process`; a forked process starts its own.
RunningScope* newest = nullptr;
long process = 0;
bool is_ending = false;

// Runs end within milliseconds, but a progress callback may take longer.
constexpr std::chrono::seconds longest_end(10);

}  // namespace

long current_process() {
#if defined(_WIN32)
  return 0;  // no forks on this platform
#else
  return long(getpid());
#endif
}

RunningScope::RunningScope(Monitor& monitor) : monitor_(monitor), process_(current_process()) {
  if (is_ending) throw FairingError(ErrorCode::cancelled, "Cancelled: the program is ending.");
  before_ = std::exchange(process, process_) == process_ ? newest : nullptr;
  if (before_) before_->after_ = this;
  newest = this;
}

RunningScope::~RunningScope() {
  if (process_ != current_process()) return;
  if (before_) before_->after_ = after_;
  (after_ ? after_->before_ : newest) = before_;
}

void end_runs() {
  is_ending = true;
  const auto end = std::chrono::steady_clock::now() + longest_end;
  if (process != current_process()) return;
  for (RunningScope* scope = newest; scope; scope = scope->before_) scope->monitor_.cancel();
  while (newest && std::chrono::steady_clock::now() < end) {
    const py::gil_scoped_release release;
    std::this_thread::sleep_for(pause);
  }
}

void bind_end() { py::module_::import("atexit").attr("register")(py::cpp_function(&end_runs)); }

}  // namespace fairing
