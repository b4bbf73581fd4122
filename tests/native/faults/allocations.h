// SPDX-License-Identifier: GPL-3.0-or-later
// Allocations of this program, counted, and one of them made to fail. All that operator new gives
// counts, and what malloc gives to the core and to Eigen.
#pragma once

#include <cstdint>

namespace fairing::test {

// Those that have not been given back. Eigen's are not among them; leaks of theirs are left to the
// address sanitizer.
std::int64_t live_allocations();

// The bytes of those, and the most that there have been since the last call of restart_peak(). On
// Linux only: elsewhere 0.
std::int64_t live_bytes();
std::int64_t peak_bytes();
void restart_peak();

// While it exists, the n-th allocation from now on fails, on whatever thread, and no other; 0: none.
class FailingAllocation {
 public:
  explicit FailingAllocation(std::int64_t n);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;

  // How many there have been so far.
  std::int64_t count() const;
};

}  // namespace fairing::test
