// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/memory.h"

#include <algorithm>
#include <vector>

#include "parallel/expected_memory.h"

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

struct OpenLedger {
  MemoryLedger* ledger;
  std::size_t expected = 0;  // bytes; 0: unknown
};
thread_local std::vector<OpenLedger> ledgers;  // the innermost is last

MemoryLedger* open_ledger() { return ledgers.empty() ? nullptr : ledgers.back().ledger; }

}  // namespace

void expect_memory(std::size_t bytes) {
  if (!ledgers.empty()) ledgers.back().expected = bytes;
}

bool is_expected_memory(std::size_t bytes) {
  if (ledgers.empty() || ledgers.back().expected == 0) return true;
  return ledgers.back().ledger->current() + bytes <=
         std::max(2 * ledgers.back().expected, small_run);
}

MemoryLedger::MemoryLedger(std::size_t limit) : limit_(limit) { ledgers.push_back({this}); }

// A solver's ledger may end before one that was opened later.
MemoryLedger::~MemoryLedger() {
  std::erase_if(ledgers, [this](const OpenLedger& open) { return open.ledger == this; });
}

void MemoryLedger::add(std::size_t bytes) {
  MemoryLedger* const open = open_ledger();
  if (!open) return;
  open->current_ += bytes;
  open->peak_ = std::max(open->peak_, open->current_);
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
