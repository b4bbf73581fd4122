// SPDX-License-Identifier: GPL-3.0-or-later
// Reports to observers that a run is about to take clearly more memory than predicted, before it
// does.
#pragma once

#include <atomic>
#include <cstddef>

namespace fairing {

constexpr double megabyte = 1e6;  // as messages have it

// Shared between a run and its observers, on any thread.
class MemoryNews {
 public:
  // For the run's thread: sets the prediction; reports the total that the run will hold. Small runs
  // and small differences are not reported. Returns when a listener has passed it on, or after a
  // moment.
  void expect(std::size_t bytes) { predicted_ = bytes; }
  void needs(std::size_t bytes);
  bool told() const { return bytes_ > 0; }

  // For a listener: registers or leaves; returns the bytes to report, 0 for none; confirms that
  // they were passed on.
  void listen(bool listens) { listens_ = listens; }
  std::size_t unheard() const {
    const std::size_t bytes = bytes_;
    return bytes > heard_ ? bytes : 0;
  }
  std::size_t predicted() const { return predicted_; }
  void heard(std::size_t bytes) { heard_ = bytes; }

  // That of the run on this thread; null: no observer.
  static MemoryNews* current();

 private:
  friend class MemoryNewsScope;
  std::atomic<std::size_t> predicted_{0}, bytes_{0}, heard_{0};
  std::atomic<bool> listens_{false};
};

// During its lifetime memory of this thread is reported to `news`.
class MemoryNewsScope {
 public:
  explicit MemoryNewsScope(MemoryNews& news);
  ~MemoryNewsScope();
  MemoryNewsScope(const MemoryNewsScope&) = delete;
  MemoryNewsScope& operator=(const MemoryNewsScope&) = delete;
};

// Announces that the run on this thread is about to take so many bytes more than its ledger holds.
void announce_memory(std::size_t bytes);

// Whether the run stays within twice its prediction, or small, with so many more bytes; for
// optional allocations.
bool is_expected_memory(std::size_t bytes);

}  // namespace fairing
