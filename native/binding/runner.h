// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>

#include "parallel/cancel.h"

namespace fairing {

// A thread that runs jobs, one at a time, while the calling thread looks after Python: every 25 ms
// it reports progress and asks for Ctrl-C, and sleeps in between. The core itself never calls
// Python.
class Runner {
 public:
  Runner();
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  // False where the system has started none: jobs run on the caller's thread then, without progress
  // on the way.
  bool has_thread() const { return thread_ != nullptr; }
  // Whether this is a forked process, in which the thread does not exist.
  bool is_left_behind() const;
  // Throws FairingError(forked) there.
  void require_own_process() const;

  // Returns when the job is over, and throws what it has thrown, or what `progress`, a callable or
  // None, has. `monitor` is what the job reports to. `watcher`, null or the caller's own, is told
  // the same and passes cancels on. Call it with Python's lock held. Throws FairingError(forked) in
  // a forked process, and FairingError(cancelled) where the interpreter is ending.
  void run(const std::function<void()>& job, Monitor& monitor, Monitor* watcher,
           const pybind11::object& progress);

  // Runs a job that nobody watches, such as a destructor; it must not throw.
  void run_quietly(const std::function<void()>& job);

 private:
  class Thread;

  long process_;
  std::unique_ptr<Thread> thread_;
};

// One job, which may be cancelled, on a thread of its own.
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
