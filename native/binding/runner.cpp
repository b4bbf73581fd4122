// SPDX-License-Identifier: GPL-3.0-or-later
#include "binding/runner.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace py = pybind11;

namespace fairing {
namespace {

// How long to sleep between two looks at Python: 40 progress calls a second are smooth, and cost
// nothing beside a run.
constexpr std::chrono::milliseconds pause(25);

}  // namespace

Runner::Runner() : thread_([this] { serve(); }) {}

Runner::~Runner() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wanted_.notify_one();
  thread_.join();
}

void Runner::serve() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wanted_.wait(lock, [&] { return job_ || stop_; });
    if (stop_) return;
    lock.unlock();
    std::exception_ptr failure;
    try {
      (*job_)();
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    failure_ = std::move(failure);
    job_ = nullptr;
    finished_.notify_all();
  }
}

void Runner::start(const std::function<void()>& job) {
  {
    const std::lock_guard lock(mutex_);
    job_ = &job;
  }
  wanted_.notify_one();
}

void Runner::run_quietly(const std::function<void()>& job) {
  start(job);
  std::unique_lock lock(mutex_);
  finished_.wait(lock, [&] { return !job_; });
}

void Runner::run(const std::function<void()>& job, Monitor& monitor, Monitor* watcher,
                 const py::object& progress) {
  std::exception_ptr python_failure;
  double last_fraction = -1;
  const auto tell_watcher = [&] {
    if (!watcher) return;
    try {
      watcher->report(monitor.phase(), monitor.fraction());
    } catch (const FairingError&) {
      monitor.cancel();
    }
  };
  const auto ask_python = [&] {
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (progress.is_none()) return;
      const double fraction = monitor.fraction();
      const py::object answer = progress(std::max(fraction, last_fraction), name(monitor.phase()));
      last_fraction = std::max(fraction, last_fraction);
      if (answer.is(py::bool_(false))) monitor.cancel();
    } catch (...) {
      python_failure = std::current_exception();
      monitor.cancel();
    }
  };
  tell_watcher();
  start(job);
  for (bool over = false; !over;) {
    {
      py::gil_scoped_release release;
      std::unique_lock lock(mutex_);
      over = finished_.wait_for(lock, pause, [&] { return !job_; });
    }
    if (!over) tell_watcher();
    if (!over && !python_failure) ask_python();
  }
  const std::exception_ptr failure = std::exchange(failure_, nullptr);
  if (!failure) tell_watcher();
  if (!python_failure && !failure) ask_python();
  if (python_failure) std::rethrow_exception(python_failure);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace fairing
