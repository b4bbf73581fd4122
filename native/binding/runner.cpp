// SPDX-License-Identifier: GPL-3.0-or-later
#include "binding/runner.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "binding/running.h"

namespace py = pybind11;

namespace fairing {
namespace {

// The Python side of a run.
class Watch {
 public:
  Watch(Monitor& monitor, Monitor* watcher, const py::object& progress)
      : monitor_(monitor), watcher_(watcher), progress_(progress) {}

  void tell_watcher() {
    if (!watcher_) return;
    try {
      watcher_->report(monitor_.phase(), monitor_.fraction());
    } catch (const FairingError&) {
      monitor_.cancel();
    }
  }

  void ask_python() {
    if (failure_) return;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (progress_.is_none()) return;
      last_fraction_ = std::max(monitor_.fraction(), last_fraction_);
      const py::object answer = progress_(last_fraction_, name(monitor_.phase()));
      if (answer.is(py::bool_(false))) monitor_.cancel();
    } catch (...) {
      failure_ = std::current_exception();
      monitor_.cancel();
    }
  }

  // Call it after the job; an exception of Python has priority.
  void end(const std::exception_ptr& failure) {
    if (!failure) {
      tell_watcher();
      ask_python();
    }
    if (failure_) std::rethrow_exception(failure_);
    if (failure) std::rethrow_exception(failure);
  }

 private:
  Monitor& monitor_;
  Monitor* watcher_;
  const py::object& progress_;
  std::exception_ptr failure_;
  double last_fraction_ = -1;
};

}  // namespace

class Runner::Thread {
 public:
  Thread() : thread_([this] { serve(); }) {}
  ~Thread() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wanted_.notify_one();
    thread_.join();
  }

  void start(const std::function<void()>& job) {
    {
      const std::lock_guard lock(mutex_);
      job_ = &job;
    }
    wanted_.notify_one();
  }
  void wait() {
    std::unique_lock lock(mutex_);
    finished_.wait(lock, [&] { return !job_; });
  }
  // Returns whether the job has ended within `time`.
  bool wait_for(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return finished_.wait_for(lock, time, [&] { return !job_; });
  }
  // The exception of the finished job; null: none.
  std::exception_ptr take_failure() { return std::exchange(failure_, nullptr); }

 private:
  void serve() {
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

  std::mutex mutex_;
  std::condition_variable wanted_, finished_;
  const std::function<void()>* job_ = nullptr;
  std::exception_ptr failure_;
  bool stop_ = false;
  std::thread thread_;
};

Runner::Runner() : process_(current_process()) {
  try {
    thread_ = std::make_unique<Thread>();
  } catch (const std::system_error&) {
  }
}

// A forked process does not have the thread, so its data are leaked.
Runner::~Runner() {
  if (is_left_behind()) static_cast<void>(thread_.release());
}

bool Runner::is_left_behind() const { return process_ != current_process(); }

void Runner::require_own_process() const {
  if (is_left_behind())
    throw FairingError(ErrorCode::forked,
                       {"This belongs to the process from which the present one was forked; its "
                        "threads are there.",
                        "Make another solver here."});
}

void Runner::run_quietly(const std::function<void()>& job) {
  if (!thread_) return job();
  thread_->start(job);
  thread_->wait();
}

void Runner::run(const std::function<void()>& job, Monitor& monitor, Monitor* watcher,
                 const py::object& progress) {
  require_own_process();
  const RunningScope running(monitor);
  Watch watch(monitor, watcher, progress);
  watch.tell_watcher();
  if (!thread_) {
    std::exception_ptr failure;
    {
      const py::gil_scoped_release release;
      try {
        job();
      } catch (...) {
        failure = std::current_exception();
      }
    }
    return watch.end(failure);
  }
  thread_->start(job);
  for (bool over = false; !over;) {
    {
      const py::gil_scoped_release release;
      over = thread_->wait_for(pause);
    }
    if (over) break;
    watch.tell_watcher();
    watch.ask_python();
    require_own_process();  // the callback may have forked
  }
  watch.end(thread_->take_failure());
}

}  // namespace fairing
