// SPDX-License-Identifier: GPL-3.0-or-later
// Threads that share index ranges, and the buffers of each thread. Every output is written by one
// index, every sum is taken over blocks of fixed size in fixed order: results are bit-identical for
// any number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <thread>
#include <vector>

#include "parallel/cancel.h"

namespace fairing {

class Workers {
 public:
  // 0: one per core. If the system starts fewer, these are used.
  explicit Workers(int threads = 0);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int count() const { return int(threads_.size()) + 1; }

  // Calls body(begin, end) on disjoint contiguous parts of [0, size), and returns when all are
  // done. `grain` is the smallest part worth a thread. Each free thread takes another part; threads
  // that sleep or have lost their core are not waited for.
  //
  // The caller's CancelScope is valid on all threads and checked before each part. An exception of
  // any part (cancelled, bad_alloc, or thrown by body()) is rethrown here; parts that have not
  // begun by then are left out. Calls do not nest.
  template <class Body>
  void for_parts(std::size_t size, std::size_t grain, Body&& body) {
    const std::size_t parts = part_count(size, grain);
    if (threads_.empty() || parts <= 1) {
      for (std::size_t part = 0; part < parts; ++part) {
        stop_if_cancelled();
        body(size * part / parts, size * (part + 1) / parts);
      }
      return;
    }
    struct Call {
      Body* body;
      std::size_t size, parts;
      const Monitor* monitor;
    } call{&body, size, parts, CancelScope::current()};
    dispatch(int(parts), &call, [](void* data, int part) {
      auto& c = *static_cast<Call*>(data);
      const CancelScope scope(c.monitor);
      stop_if_cancelled();
      const std::size_t begin = c.size * std::size_t(part) / c.parts;
      const std::size_t end = c.size * std::size_t(part + 1) / c.parts;
      (*c.body)(begin, end);
    });
  }

  // Calls body(i) for each i in [0, size), likewise.
  template <class Body>
  void for_each(std::size_t size, std::size_t grain, Body&& body) {
    for_parts(size, grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) body(i);
    });
  }

 private:
  using Task = void (*)(void*, int);
  using State = std::uint64_t;
  // A cancelled run finishes the parts that it has begun; at least `enough_parts`, as far as the
  // grain allows, keep that short. state_ has 16 bits for their number.
  static constexpr std::size_t enough_parts = 256, grains_a_part = 8, most_parts = 0xffff;

  std::size_t part_count(std::size_t size, std::size_t grain) const {
    if (size == 0) return 0;
    const std::size_t grains = std::max<std::size_t>(1, grain ? size / grain : size);
    return std::min({grains, std::max(enough_parts, grains / grains_a_part), most_parts});
  }

  bool start_thread();
  void dispatch(int parts, void* data, Task task);
  void serve();
  void work(State state, bool from_end);
  void run_part(Task task, void* data, int part);

  std::vector<std::thread> threads_;
  // Bits 0–15: the first unclaimed part; 16–31: the end of the unclaimed parts; 32–63: the call's
  // number. A thread reads task_ and data_, then claims a part by compare-and-swap: its success
  // proves that the call is still the same, and so that what was read belongs to the part.
  std::atomic<State> state_{0};
  std::atomic<Task> task_{nullptr};
  std::atomic<void*> data_{nullptr};
  std::atomic<std::uint32_t> calls_{0};  // idle threads wait for a change
  std::atomic<std::uint32_t> unfinished_{0};
  std::atomic<bool> stop_{false};
  std::exception_ptr failure_;
  std::atomic<bool> failed_{false};
};

// --- buffers of a thread ---

// Scratch memory that each thread keeps from call to call, because allocating and clearing large
// buffers in every pass would cost as much as the pass. A worker's buffers are freed with its
// thread; the owner's thread frees its own when the Workers are destroyed.
template <class T>
struct ThreadScratch {
  // For accumulate() (grid/accumulate.h): the closed face and the edge that a body writes, and a
  // work buffer for the body.
  std::vector<T> closed, run, work;
  std::vector<T> gathered;  // the closed faces or edges that a body reads
};

template <class T>
ThreadScratch<T>& thread_scratch() {
  thread_local ThreadScratch<T> own;
  return own;
}

// Memory for `size` unset numbers; valid until the next call for the same buffer.
template <class T>
T* room_in(std::vector<T>& buffer, std::size_t size) {
  if (buffer.size() < size) buffer.resize(size);
  return buffer.data();
}

// The columns of a sparse matrix that a row has used: those whose marks exceed `last`. Raising
// `last` clears all of them.
struct ColumnMarks {
  std::vector<std::uint32_t> mark;
  std::uint32_t last = 0;

  void fit(std::size_t columns) {
    constexpr std::uint32_t most = std::uint32_t(1) << 31;
    if (mark.size() < columns) mark.resize(columns, 0);
    if (last < most) return;
    std::fill(mark.begin(), mark.end(), 0);
    last = 0;
  }
};
inline ColumnMarks& thread_column_marks() {
  thread_local ColumnMarks own;
  return own;
}

inline void release_thread_scratch() {
  thread_column_marks() = {};
  thread_scratch<float>() = {};
  thread_scratch<double>() = {};
}

}  // namespace fairing
