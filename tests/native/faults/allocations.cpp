// SPDX-License-Identifier: GPL-3.0-or-later
#include "allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>
#if defined(__linux__)
#include <malloc.h>
#endif

namespace {

std::atomic<std::int64_t> live{0}, bytes{0}, peak{0}, counted{0}, failing{0};
std::atomic<bool> counts{false};

bool fails() {
  if (!counts.load(std::memory_order_relaxed)) return false;
  return counted.fetch_add(1, std::memory_order_relaxed) + 1 ==
         failing.load(std::memory_order_relaxed);
}

}  // namespace

#if defined(__linux__)
// What the core's object files call as malloc comes here (the linker's --wrap).
extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* p, std::size_t size);
void* __wrap_malloc(std::size_t size) { return fails() ? nullptr : __real_malloc(size); }
void* __wrap_calloc(std::size_t count, std::size_t size) {
  return fails() ? nullptr : __real_calloc(count, size);
}
void* __wrap_realloc(void* p, std::size_t size) {
  return fails() ? nullptr : __real_realloc(p, size);
}
}
#else
#define __real_malloc std::malloc
#endif

namespace {

std::int64_t size_of([[maybe_unused]] void* p) {
#if defined(__linux__)
  return std::int64_t(malloc_usable_size(p));
#else
  return 0;
#endif
}

void* taken(void* p) {
  if (!p) throw std::bad_alloc();
  live.fetch_add(1, std::memory_order_relaxed);
  const std::int64_t now = bytes.fetch_add(size_of(p)) + size_of(p);
  std::int64_t most = peak.load();
  while (now > most && !peak.compare_exchange_weak(most, now)) {
  }
  return p;
}

void give_back(void* p) {
  if (p) {
    live.fetch_sub(1, std::memory_order_relaxed);
    bytes.fetch_sub(size_of(p));
  }
  std::free(p);
}

}  // namespace

void* operator new(std::size_t size) {
  return taken(fails() ? nullptr : __real_malloc(size ? size : 1));
}
// The sanitizers have one of their own, whose memory the delete below must not get.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto step = std::size_t(alignment);
  return taken(fails() ? nullptr : std::aligned_alloc(step, (size + step) / step * step));
}
void operator delete(void* p) noexcept { give_back(p); }
void operator delete(void* p, std::size_t) noexcept { give_back(p); }
void operator delete(void* p, std::align_val_t) noexcept { give_back(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { give_back(p); }

namespace fairing::test {

std::int64_t live_allocations() { return live.load(); }
std::int64_t live_bytes() { return bytes.load(); }
std::int64_t peak_bytes() { return peak.load(); }
void restart_peak() { peak = bytes.load(); }

FailingAllocation::FailingAllocation(std::int64_t n) {
  counted = 0;
  failing = n;
  counts = true;
}

FailingAllocation::~FailingAllocation() { counts = false; }

std::int64_t FailingAllocation::count() const { return counted.load(); }

}  // namespace fairing::test
