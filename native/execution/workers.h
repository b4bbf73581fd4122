// SPDX-License-Identifier: GPL-3.0-or-later
// A few threads that split index ranges. Every output is written by one index, every sum is taken over blocks of
// fixed size in fixed order: results are bit-identical for any number of threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <thread>
#include <vector>

namespace fairing {

class Workers {
 public:
  explicit Workers(int threads = 0);  // 0: one a core
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int count() const { return int(threads_.size()) + 1; }

  // Calls body(begin, end) on disjoint contiguous parts of [0, size), and returns when all are done. `grain` is the
  // least part worth a thread of its own. An exception of any part is rethrown here.
  template <class Body>
  void for_parts(std::size_t size, std::size_t grain, Body&& body) {
    const std::size_t most = grain ? (size + grain - 1) / grain : size;
    const int parts = int(most < std::size_t(count()) ? most : std::size_t(count()));
    if (parts <= 1) {
      if (size) body(std::size_t(0), size);
      return;
    }
    struct Call {
      Body* body;
      std::size_t size;
      int parts;
    } call{&body, size, parts};
    dispatch(parts, &call, [](void* data, int part) {
      auto& c = *static_cast<Call*>(data);
      const std::size_t begin = c.size * std::size_t(part) / std::size_t(c.parts);
      const std::size_t end = c.size * std::size_t(part + 1) / std::size_t(c.parts);
      (*c.body)(begin, end);
    });
  }

 private:
  using Task = void (*)(void*, int);
  void dispatch(int parts, void* data, Task task);
  void serve(int id);
  void run_part(int part);

  std::vector<std::thread> threads_;
  std::atomic<std::uint32_t> generation_{0};
  std::atomic<int> pending_{0};
  std::atomic<bool> stop_{false};
  Task task_ = nullptr;
  void* data_ = nullptr;
  int parts_ = 0;
  std::exception_ptr failure_;
  std::atomic<bool> failed_{false};
};

}  // namespace fairing
