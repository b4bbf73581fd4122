// SPDX-License-Identifier: GPL-3.0-or-later
// Eigen's products and solves have the same bits on every machine: no fused operations, and blocks
// that depend neither on the processor's instructions nor on its caches.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <bit>
#include <cstdint>

namespace {

using Eigen::MatrixXd;

// Numbers of [-1/2, 1/2) by xorshift: the same on every machine.
MatrixXd numbers(Eigen::Index rows, Eigen::Index columns) {
  std::uint64_t state = 88172645463325252u;
  MatrixXd made(rows, columns);
  for (double& number : made.reshaped()) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    number = double(state >> 11) * 0x1p-53 - 0.5;
  }
  return made;
}

// FNV's hash of the numbers' bits, by whole words.
std::uint64_t bits(const MatrixXd& matrix) {
  std::uint64_t hash = 1469598103934665603u;
  for (const double number : matrix.reshaped())
    hash = (hash ^ std::bit_cast<std::uint64_t>(number)) * 1099511628211u;
  return hash;
}

MatrixXd definite(Eigen::Index size) {
  const MatrixXd a = numbers(size, size + 3);
  return a * a.transpose() + MatrixXd::Identity(size, size);
}

}  // namespace

TEST(EigenBits, BlocksAreThoseOfX86) {
  using Blocks = Eigen::internal::gebp_traits<double, double>;
  EXPECT_EQ(int(Blocks::mr), 4);
  EXPECT_EQ(int(Blocks::nr), 4);
  EXPECT_EQ(Eigen::l1CacheSize(), 1 << 15);
  EXPECT_EQ(Eigen::l2CacheSize(), 1 << 18);
  EXPECT_EQ(Eigen::l3CacheSize(), 1 << 21);
}

TEST(EigenBits, Product) {
  EXPECT_EQ(bits(numbers(7, 12) * numbers(12, 7)), 953572033056314308u);
  EXPECT_EQ(bits(numbers(300, 700) * numbers(700, 5)), 2450525859034518980u);
}

TEST(EigenBits, FixedSizeSolve) {
  using Small = Eigen::Matrix<double, 5, 5>;
  const Eigen::LLT<Small> factor(Small{definite(5)});
  EXPECT_EQ(bits(factor.solve(numbers(5, 7))), 3661765847838900793u);
}

TEST(EigenBits, LargeSolve) {
  const Eigen::LLT<MatrixXd> factor(definite(130));
  EXPECT_EQ(bits(factor.matrixL()), 6426581685141273195u);
  EXPECT_EQ(bits(factor.solve(numbers(130, 7))), 12632260179495912491u);
}
