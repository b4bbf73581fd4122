// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/memory.h"

#include <algorithm>

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
thread_local MemoryLedger* open_ledger = nullptr;
}

MemoryLedger::MemoryLedger(std::size_t limit) : limit_(limit) { open_ledger = this; }

MemoryLedger::~MemoryLedger() { open_ledger = nullptr; }

void MemoryLedger::add(std::size_t bytes) {
  if (!open_ledger) return;
  open_ledger->current_ += bytes;
  open_ledger->peak_ = std::max(open_ledger->peak_, open_ledger->current_);
}

void MemoryLedger::remove(std::size_t bytes) {
  if (open_ledger) open_ledger->current_ -= std::min(bytes, open_ledger->current_);
}

bool MemoryLedger::fits(std::size_t bytes) {
  if (!open_ledger || open_ledger->limit_ == 0) return true;
  return bytes <= open_ledger->limit_ && open_ledger->current_ <= open_ledger->limit_ - bytes;
}

void prefer_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  // Whole pages only: what lies beside the array stays as it is.
  constexpr std::uintptr_t page = std::uintptr_t(1) << 21;
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = (begin + page - 1) / page * page,
                       last = (begin + bytes) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);  // a wish
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
