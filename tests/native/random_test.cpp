// SPDX-License-Identifier: GPL-3.0-or-later
#include "random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace fairing::test {
namespace {

TEST(Random, IsTheSameWithEveryLibrary) {
  std::mt19937 random(5);
  UniformReal<> number(-1, 1);
  Normal<> normal;
  EXPECT_DOUBLE_EQ(number(random), -0.88963975840155352);
  EXPECT_DOUBLE_EQ(normal(random), -0.43921630780876664);
  EXPECT_EQ(UniformInt(0, 99)(random), 91);
}

#if defined(__GLIBCXX__)
template <class Ours, class Theirs>
void expect_alike(Ours ours, Theirs theirs) {
  std::mt19937 first(3), second(3);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(ours(first), theirs(second)) << i;
}

TEST(Random, IsThatOfGnusLibrary) {
  expect_alike(UniformReal<double>(-0.3, 2), std::uniform_real_distribution<double>(-0.3, 2));
  expect_alike(UniformReal<float>(-1, 1), std::uniform_real_distribution<float>(-1, 1));
  expect_alike(Normal<double>(0, 0.1), std::normal_distribution<double>(0, 0.1));
  expect_alike(Normal<float>(), std::normal_distribution<float>());
  expect_alike(UniformInt(3, 9), std::uniform_int_distribution<int>(3, 9));
  for (int count = 0; count < 50; ++count) {
    std::vector<int> ours(std::size_t(count), 0);
    std::iota(ours.begin(), ours.end(), 0);
    std::vector<int> theirs = ours;
    std::mt19937 first(7), second(7);
    shuffle_things(ours, first);
    std::shuffle(theirs.begin(), theirs.end(), second);
    EXPECT_EQ(ours, theirs) << count;
  }
}
#endif

}  // namespace
}  // namespace fairing::test
