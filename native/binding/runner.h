// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "parallel/monitor.h"

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

  // Returns when the job is over, and throws what it has thrown, or what `progress`, a callable or
  // None, has. `monitor` is what the job reports to. `watcher`, null or the caller's own, is told
  // the same and passes cancels on. Call it with Python's lock held.
  void run(const std::function<void()>& job, Monitor& monitor, Monitor* watcher,
           const pybind11::object& progress);

  // Runs a job that nobody watches, such as a destructor; it must not throw.
  void run_quietly(const std::function<void()>& job);

 private:
  void serve();
  void start(const std::function<void()>& job);

  std::mutex mutex_;
  std::condition_variable wanted_, finished_;
  const std::function<void()>* job_ = nullptr;
  std::exception_ptr failure_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace fairing
