// SPDX-License-Identifier: GPL-3.0-or-later
// Word of a run that is about to take markedly more memory than was predicted, to whoever watches
// it: before that memory is taken.
#pragma once

#include <atomic>
#include <cstddef>

namespace fairing {

constexpr double megabyte = 1e6;  // as messages have it

// Shared between a run and whoever watches it, on any thread.
class MemoryNews {
 public:
  // For the run's thread: what was predicted, and that it will hold so much in all. Small runs, and
  // what is nearly as predicted, are nobody's concern. Returns once a listener has passed it on, or
  // after a moment.
  void expect(std::size_t bytes) { predicted_ = bytes; }
  void needs(std::size_t bytes);
  bool told() const { return bytes_ > 0; }

  // For a listener: that there is one, or no longer; how many bytes, 0 where that is no news; and
  // that it has been passed on.
  void listen(bool listens) { listens_ = listens; }
  std::size_t unheard() const {
    const std::size_t bytes = bytes_;
    return bytes > heard_ ? bytes : 0;
  }
  std::size_t predicted() const { return predicted_; }
  void heard(std::size_t bytes) { heard_ = bytes; }

  // Of the run on this thread; null: nobody wants to know.
  static MemoryNews* current();

 private:
  friend class MemoryNewsScope;
  std::atomic<std::size_t> predicted_{0}, bytes_{0}, heard_{0};
  std::atomic<bool> listens_{false};
};

// While it exists, what this thread takes is told to `news`.
class MemoryNewsScope {
 public:
  explicit MemoryNewsScope(MemoryNews& news);
  ~MemoryNewsScope();
  MemoryNewsScope(const MemoryNewsScope&) = delete;
  MemoryNewsScope& operator=(const MemoryNewsScope&) = delete;
};

// That the run on this thread is about to take so many bytes more than its ledger holds.
void announce_memory(std::size_t bytes);

// Whether so many more leave the run within twice what was predicted, or small: to be asked before
// what it can do without.
bool is_expected_memory(std::size_t bytes);

}  // namespace fairing
