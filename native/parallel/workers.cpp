// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/workers.h"

#include <algorithm>
#include <new>
#include <system_error>

namespace fairing {
namespace {

// Passes over small levels are microseconds apart: threads spin this many times before they sleep.
constexpr int spins = 4000;

inline void relax() {
#if defined(__x86_64__) || defined(_M_X64)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("isb");  // `yield` does nothing on most of these processors
#endif
}

template <class Done>
void await(std::atomic<std::uint32_t>& atomic, Done done) {
  for (int i = 0; i < spins; ++i) {
    if (done(atomic.load(std::memory_order_acquire))) return;
    relax();
  }
  for (;;) {
    const std::uint32_t seen = atomic.load(std::memory_order_acquire);
    if (done(seen)) return;
    atomic.wait(seen, std::memory_order_acquire);
  }
}

constexpr std::uint64_t one_first = 1, one_end = std::uint64_t(1) << 16,
                        one_call = std::uint64_t(1) << 32;
constexpr std::uint32_t first_of(std::uint64_t state) { return std::uint32_t(state & 0xffff); }
constexpr std::uint32_t end_of(std::uint64_t state) { return std::uint32_t(state >> 16 & 0xffff); }
constexpr std::uint64_t call_of(std::uint64_t state) { return state >> 32; }

}  // namespace

Workers::Workers(int threads) {
  if (threads <= 0) threads = int(std::max(1u, std::thread::hardware_concurrency()));
  threads_.reserve(std::size_t(threads - 1));
  while (count() < threads && start_thread()) {
  }
}

bool Workers::start_thread() {
  try {
    threads_.emplace_back([this] { serve(); });
    return true;
  } catch (const std::system_error&) {
  } catch (const std::bad_alloc&) {
  }
  return false;
}

Workers::~Workers() {
  stop_.store(true, std::memory_order_release);
  calls_.fetch_add(1, std::memory_order_release);
  calls_.notify_all();
  for (auto& thread : threads_) thread.join();
  release_thread_scratch();
}

void Workers::run_part(Task task, void* data, int part) {
  try {
    if (!failed_.load(std::memory_order_relaxed)) task(data, part);
  } catch (...) {
    if (!failed_.exchange(true)) failure_ = std::current_exception();
  }
  if (unfinished_.fetch_sub(1, std::memory_order_acq_rel) == 1) unfinished_.notify_one();
}

// The caller takes parts from the front, the others from the end, so that in the next pass each
// thread finds its last parts in its cache.
void Workers::work(State state, bool from_end) {
  const std::uint64_t call = call_of(state);
  while (call_of(state) == call && first_of(state) < end_of(state)) {
    const Task task = task_.load(std::memory_order_relaxed);
    void* const data = data_.load(std::memory_order_relaxed);
    const State taken = from_end ? state - one_end : state + one_first;
    if (!state_.compare_exchange_weak(state, taken, std::memory_order_acq_rel,
                                      std::memory_order_acquire))
      continue;
    run_part(task, data, int(from_end ? end_of(state) - 1 : first_of(state)));
    state = state_.load(std::memory_order_acquire);
  }
}

void Workers::dispatch(int parts, void* data, Task task) {
  task_.store(task, std::memory_order_relaxed);
  data_.store(data, std::memory_order_relaxed);
  failed_.store(false, std::memory_order_relaxed);
  failure_ = nullptr;
  unfinished_.store(std::uint32_t(parts), std::memory_order_relaxed);
  const State state = (call_of(state_.load(std::memory_order_relaxed)) + 1) * one_call +
                      std::uint64_t(parts) * one_end;
  state_.store(state, std::memory_order_release);
  calls_.fetch_add(1, std::memory_order_release);
  calls_.notify_all();
  work(state, false);
  await(unfinished_, [](std::uint32_t left) { return left == 0; });
  if (failed_.load()) std::rethrow_exception(failure_);
}

void Workers::serve() {
  std::uint32_t seen = 0;
  for (;;) {
    await(calls_, [&](std::uint32_t now) { return now != seen; });
    seen = calls_.load(std::memory_order_acquire);
    if (stop_.load(std::memory_order_acquire)) return;
    work(state_.load(std::memory_order_acquire), true);
  }
}

}  // namespace fairing
