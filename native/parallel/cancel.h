// SPDX-License-Identifier: GPL-3.0-or-later
// Cancellation. A run sets its Monitor once, in a CancelScope; all functions that it calls, on its
// own thread and on its Workers' threads, check it by stop_if_cancelled(). Without a scope a run
// cannot be cancelled. So every long function of the core may throw FairingError(cancelled).
#pragma once

#include <algorithm>
#include <cstddef>

#include "parallel/monitor.h"

namespace fairing {

// During its lifetime stop_if_cancelled() on this thread checks this monitor (null: none).
class CancelScope {
 public:
  explicit CancelScope(const Monitor* monitor) : before_(own()) { own() = monitor; }
  ~CancelScope() { own() = before_; }
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

  static const Monitor* current() { return own(); }

 private:
  static const Monitor*& own() {
    thread_local const Monitor* monitor = nullptr;
    return monitor;
  }
  const Monitor* before_;
};

// Throws FairingError(cancelled) if this thread's run has been cancelled.
inline void stop_if_cancelled() {
  if (const Monitor* monitor = CancelScope::current()) monitor->check_cancelled();
}

// The same for long loops: checks at every 1024th step only.
inline void stop_if_cancelled(std::size_t step) {
  if (step % 1024 == 0) stop_if_cancelled();
}

// The numbers 0 … count - 1, for long loops on one thread: checks like stop_if_cancelled(step).
template <class N>
class Cancellable {
 public:
  explicit Cancellable(N count) : count_(count) {}

  struct Iterator {
    N i;
    N operator*() const {
      stop_if_cancelled(std::size_t(i));
      return i;
    }
    void operator++() { ++i; }
    bool operator!=(const Iterator& end) const { return i < end.i; }
  };
  Iterator begin() const { return {0}; }
  Iterator end() const { return {count_}; }

 private:
  N count_;
};

// The same in the loop over a face's rows, which may be many.
inline void stop_in_large_face(int row) {
  if (row % 64 == 0) stop_if_cancelled();
}

// Calls body(begin, end) for one stretch of [0, size) after another and checks before each: for
// simple loops over long arrays on one thread.
template <class Body>
void for_stretches(std::size_t size, Body&& body) {
  constexpr std::size_t at_once = std::size_t(1) << 20;  // numbers
  for (std::size_t begin = 0; begin < size; begin += at_once) {
    stop_if_cancelled();
    body(begin, std::min(size, begin + at_once));
  }
}

// std::fill and std::copy (with conversion) that can be cancelled.
template <class T>
void fill_long(T* to, std::size_t size, T value) {
  for_stretches(
      size, [&](std::size_t begin, std::size_t end) { std::fill(to + begin, to + end, value); });
}

}  // namespace fairing
