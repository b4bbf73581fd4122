// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/memory.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

#include "parallel/memory_news.h"

#if defined(_WIN32)
#include <windows.h>
#else
#include <unistd.h>
#endif
#if defined(__linux__)
#include <sys/mman.h>

#include <cstdint>
#endif

namespace fairing {
namespace {

thread_local std::vector<MemoryLedger*> ledgers;  // the innermost is last
thread_local MemoryNews* run_news = nullptr;

MemoryLedger* open_ledger() { return ledgers.empty() ? nullptr : ledgers.back(); }

// A run with less memory than this is not announced, nor one within a tenth of the prediction.
// Beyond that every additional quarter is.
constexpr std::size_t small_run = std::size_t(16) << 20, slack = 10, further = 4;
constexpr int longest_wait = 200;  // for a listener, in milliseconds

}  // namespace

void MemoryNews::needs(std::size_t bytes) {
  const std::size_t before = bytes_, predicted = predicted_;
  const std::size_t allowed =
      before > 0 ? before + before / further : predicted + predicted / slack;
  if (predicted == 0 || bytes <= std::max(allowed, small_run)) return;
  bytes_ = bytes;
  for (int i = 0; i < longest_wait && listens_ && unheard() > 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

MemoryNews* MemoryNews::current() { return run_news; }

MemoryNewsScope::MemoryNewsScope(MemoryNews& news) { run_news = &news; }

MemoryNewsScope::~MemoryNewsScope() { run_news = nullptr; }

void announce_memory(std::size_t bytes) {
  if (const MemoryLedger* const open = open_ledger(); open && run_news)
    run_news->needs(open->current() + bytes);
}

bool is_expected_memory(std::size_t bytes) {
  const MemoryLedger* const open = open_ledger();
  if (!open || !run_news || run_news->predicted() == 0) return true;
  return open->current() + bytes <= std::max(2 * run_news->predicted(), small_run);
}

MemoryLedger::MemoryLedger(std::size_t limit) : limit_(limit) { ledgers.push_back(this); }

// A solver's ledger may end before one that was opened later.
MemoryLedger::~MemoryLedger() { std::erase(ledgers, this); }

void MemoryLedger::add(std::size_t bytes) {
  MemoryLedger* const open = open_ledger();
  if (!open) return;
  open->current_ += bytes;
  open->peak_ = std::max(open->peak_, open->current_);
  announce_memory(0);  // pages of a new array count once they are written
}

void MemoryLedger::remove(std::size_t bytes) {
  if (MemoryLedger* const open = open_ledger()) open->current_ -= std::min(bytes, open->current_);
}

std::size_t MemoryLedger::held() { return open_ledger() ? open_ledger()->current_ : 0; }

std::size_t MemoryLedger::highest() { return open_ledger() ? open_ledger()->peak_ : 0; }

bool MemoryLedger::fits(std::size_t bytes) {
  const MemoryLedger* const open = open_ledger();
  if (!open || open->limit_ == 0) return true;
  return bytes <= open->limit_ && open->current_ <= open->limit_ - bytes;
}

void prefer_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  // Whole pages only; memory next to the array is not affected.
  constexpr std::uintptr_t page = std::uintptr_t(1) << 21;
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = (begin + page - 1) / page * page,
                       last = (begin + bytes) / page * page;
  if (first < last)
    madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);  // only a hint
#endif
}

std::size_t physical_memory() {
#if defined(_WIN32)
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof status;
  return GlobalMemoryStatusEx(&status) ? std::size_t(status.ullTotalPhys) : 0;
#else
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && page > 0 ? std::size_t(pages) * std::size_t(page) : 0;
#endif
}

}  // namespace fairing
