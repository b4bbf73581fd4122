// SPDX-License-Identifier: GPL-3.0-or-later
// Ledgers of counted memory: one run beside another on the same thread.
#include "parallel/memory.h"

#include <gtest/gtest.h>

#include <optional>

#include "meshes.h"
#include "strain/strain.h"

namespace fairing::test {
namespace {

TEST(MemoryLedger, one_that_ends_gives_way_to_the_one_before) {
  const MemoryLedger run(1000);
  MemoryLedger::add(600);
  {
    const MemoryLedger another;
    MemoryLedger::add(70);
    EXPECT_EQ(another.current(), 70u);
    EXPECT_TRUE(MemoryLedger::fits(5000));
  }
  EXPECT_EQ(MemoryLedger::held(), 600u);
  EXPECT_FALSE(MemoryLedger::fits(500));
  MemoryLedger::add(10);
  EXPECT_EQ(run.current(), 610u);
}

TEST(MemoryLedger, one_that_ends_first_leaves_the_later_one_open) {
  std::optional<MemoryLedger> solver(std::in_place);
  const MemoryLedger run;
  solver.reset();
  MemoryLedger::add(5);
  EXPECT_EQ(run.current(), 5u);
}

// Its limit is that of the options; what was open before hears of nothing.
TEST(MemoryLedger, strain_has_one_of_its_own) {
  const MemoryLedger run;
  Monitor monitor;
  measure_strain(torus(8, 6).view(), FairOptions(), monitor);
  EXPECT_EQ(run.peak(), 0u);
}

}  // namespace
}  // namespace fairing::test
