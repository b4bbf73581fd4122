// SPDX-License-Identifier: GPL-3.0-or-later
// A few threads that split index ranges. Every output is written by one index, every sum is taken over blocks of
// fixed size in fixed order: results are bit-identical for any number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <thread>
#include <vector>

#include "execution/cancel.h"

namespace fairing {

class Workers {
 public:
  explicit Workers(int threads = 0);  // 0: one a core
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int count() const { return int(threads_.size()) + 1; }

  // Calls body(begin, end) on disjoint contiguous parts of [0, size), and returns when all are done. `grain` is the
  // least part worth handing out. Whoever is free takes the next part: a thread that sleeps, or has lost its core to
  // somebody else, is not waited for. An exception of any part is rethrown here, and parts that nobody has begun then
  // are left out. Before each part the caller's CancelScope is asked, which holds on the other threads meanwhile.
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

 private:
  using Task = void (*)(void*, int);
  using State = std::uint64_t;
  static constexpr std::size_t parts_a_thread = 4;
  // A cancelled run ends its parts first: they have to be small, but no smaller than that needs.
  static constexpr std::size_t enough_parts = 256, grains_a_part = 8, most_parts = 0xffff;

  std::size_t part_count(std::size_t size, std::size_t grain) const {
    if (size == 0) return 0;
    const std::size_t grains = std::max<std::size_t>(1, grain ? size / grain : size);
    const std::size_t wanted =
        std::max({parts_a_thread * std::size_t(count()), enough_parts, grains / grains_a_part});
    return std::min({grains, wanted, most_parts});
  }

  void dispatch(int parts, void* data, Task task);
  void serve();
  void work(State state, bool from_end);
  void run_part(Task task, void* data, int part);

  std::vector<std::thread> threads_;
  // The parts that nobody has taken yet, [first, end), below the number of the call: first in 16 bits, end in the next 16.
  // What the call is about is read before a part is taken, and holds if `state_` has not changed by then.
  std::atomic<State> state_{0};
  std::atomic<Task> task_{nullptr};
  std::atomic<void*> data_{nullptr};
  std::atomic<std::uint32_t> calls_{0};  // what idle threads wait for
  std::atomic<std::uint32_t> unfinished_{0};
  std::atomic<bool> stop_{false};
  std::exception_ptr failure_;
  std::atomic<bool> failed_{false};
};

}  // namespace fairing
