// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>

#include "parallel/cancel.h"

namespace fairing {

// A thread that runs jobs, one at a time. Meanwhile the calling thread serves Python: every 25 ms
// it reports progress and checks for Ctrl-C. The core itself never calls Python.
class Runner {
 public:
  Runner();
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  // False if the system could not start a thread: then jobs run on the caller's, without progress.
  bool has_thread() const { return thread_ != nullptr; }
  // Whether this is a forked process, which does not have the thread.
  bool is_left_behind() const;
  // Throws FairingError(forked) there.
  void require_own_process() const;

  // Returns at the end of the job, and rethrows its exceptions and those of `progress`, a callable
  // or None. The job reports to `monitor`. `watcher`, null or the caller's own, receives the same
  // reports and passes cancellation on. Call it with Python's lock. Throws FairingError(forked) in
  // a forked process, and FairingError(cancelled) while the interpreter is ending.
  void run(const std::function<void()>& job, Monitor& monitor, Monitor* watcher,
           const pybind11::object& progress);

  // Runs a job without progress, such as a destructor; it must not throw.
  void run_quietly(const std::function<void()>& job);

 private:
  class Thread;

  long process_;
  std::unique_ptr<Thread> thread_;
};

// Runs one job, which may be cancelled, on its own thread.
template <class Job>
void run_once(Monitor& monitor, const pybind11::object& progress, const Job& job) {
  Runner().run(
      [&] {
        const CancelScope scope(&monitor);
        job();
      },
      monitor, nullptr, progress);
}

}  // namespace fairing
