// SPDX-License-Identifier: GPL-3.0-or-later
// Large arrays whose bytes are counted for a run's peak. Errors: std::bad_alloc.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace fairing {

// Counts the bytes of the Arrays that the current thread allocates while this ledger is open. The
// last opened ledger counts; worker threads never allocate Arrays.
class MemoryLedger {
 public:
  // `limit`, in bytes; 0: none. Callers have to check it with fits().
  explicit MemoryLedger(std::size_t limit = 0);
  ~MemoryLedger();
  MemoryLedger(const MemoryLedger&) = delete;
  MemoryLedger& operator=(const MemoryLedger&) = delete;

  std::size_t peak() const { return peak_; }
  std::size_t current() const { return current_; }

  static void add(std::size_t bytes);
  static void remove(std::size_t bytes);
  // Bytes of the open ledger, now and at its peak.
  static std::size_t held();
  static std::size_t highest();
  // Whether so many more bytes are within the open ledger's limit.
  static bool fits(std::size_t bytes);

 private:
  std::size_t limit_;
  std::size_t current_ = 0;
  std::size_t peak_ = 0;
};

// Bytes of other memory, counted by the open ledger during this object's lifetime.
class CountedBytes {
 public:
  explicit CountedBytes(std::size_t bytes) : bytes_(bytes) { MemoryLedger::add(bytes_); }
  ~CountedBytes() { MemoryLedger::remove(bytes_); }
  CountedBytes(const CountedBytes&) = delete;
  CountedBytes& operator=(const CountedBytes&) = delete;

 private:
  std::size_t bytes_;
};

// Requests large pages from the system, if it has them: mapping and unmapping are many times as
// fast.
void prefer_large_pages(void* memory, std::size_t bytes);

// Physical memory of the machine in bytes (0 if unknown).
std::size_t physical_memory();

template <class T>
struct CountingAllocator {
  using value_type = T;
  CountingAllocator() = default;
  template <class U>
  CountingAllocator(const CountingAllocator<U>&) {}

  T* allocate(std::size_t n) {
    T* p = std::allocator<T>().allocate(n);
    MemoryLedger::add(n * sizeof(T));
    prefer_large_pages(p, n * sizeof(T));
    return p;
  }
  void deallocate(T* p, std::size_t n) {
    MemoryLedger::remove(n * sizeof(T));
    std::allocator<T>().deallocate(p, n);
  }
  // resize() leaves numbers unset: every array is written before it is read, and clearing it would
  // cost as much bandwidth as a pass.
  template <class U>
  void construct(U* p) {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
  bool operator==(const CountingAllocator&) const { return true; }
};

template <class T>
using Array = std::vector<T, CountingAllocator<T>>;

}  // namespace fairing
