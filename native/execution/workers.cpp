// SPDX-License-Identifier: GPL-3.0-or-later
#include "execution/workers.h"

#include <algorithm>

namespace fairing {
namespace {

// Passes over small levels follow one another within microseconds: look for a while before sleeping.
constexpr int spins = 4000;

inline void relax() {
#if defined(__x86_64__) || defined(_M_X64)
  __builtin_ia32_pause();
#endif
}

template <class Atomic, class Value, class Done>
void await(Atomic& atomic, Value, Done done) {
  for (int i = 0; i < spins; ++i) {
    if (done(atomic.load(std::memory_order_acquire))) return;
    relax();
  }
  for (;;) {
    const auto seen = atomic.load(std::memory_order_acquire);
    if (done(seen)) return;
    atomic.wait(seen, std::memory_order_acquire);
  }
}

}  // namespace

Workers::Workers(int threads) {
  if (threads <= 0) threads = int(std::max(1u, std::thread::hardware_concurrency()));
  threads_.reserve(std::size_t(threads - 1));
  for (int id = 1; id < threads; ++id) threads_.emplace_back([this, id] { serve(id); });
}

Workers::~Workers() {
  stop_.store(true, std::memory_order_release);
  generation_.fetch_add(1, std::memory_order_release);
  generation_.notify_all();
  for (auto& thread : threads_) thread.join();
}

void Workers::run_part(int part) {
  try {
    task_(data_, part);
  } catch (...) {
    if (!failed_.exchange(true)) failure_ = std::current_exception();
  }
}

void Workers::dispatch(int parts, void* data, Task task) {
  task_ = task;
  data_ = data;
  parts_ = parts;
  failed_.store(false);
  failure_ = nullptr;
  pending_.store(int(threads_.size()), std::memory_order_relaxed);
  generation_.fetch_add(1, std::memory_order_release);
  generation_.notify_all();
  run_part(0);
  await(pending_, 0, [](int left) { return left == 0; });
  if (failed_.load()) std::rethrow_exception(failure_);
}

void Workers::serve(int id) {
  std::uint32_t seen = 0;
  for (;;) {
    await(generation_, seen, [&](std::uint32_t now) { return now != seen; });
    ++seen;
    if (stop_.load(std::memory_order_acquire)) return;
    if (id < parts_) run_part(id);
    if (pending_.fetch_sub(1, std::memory_order_acq_rel) == 1) pending_.notify_one();
  }
}

}  // namespace fairing
