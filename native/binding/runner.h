// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "execution/monitor.h"

namespace fairing {

// A thread that runs jobs while the calling thread looks after Python: progress, Ctrl-C. It sleeps in between.
class Runner {
 public:
  Runner();
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  // Returns when the job is over, and throws what it has thrown. `monitor` is what the job reports to; `watcher`, the
  // caller's own, if there is one, hears of it, and cancels it.
  void run(const std::function<void()>& job, Monitor& monitor, Monitor* watcher,
           const pybind11::object& progress);

  // A job that nobody watches, such as a destructor. It must not throw.
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
