// SPDX-License-Identifier: GPL-3.0-or-later
// J^T S J, summed up column by column, against Eigen's products of whole matrices.
#include "multigrid/assembly.h"

#include <gtest/gtest.h>

#include <random>

namespace fairing {
namespace {

// About three entries a column, and columns without any.
SparseMatrix random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < 3 * columns; ++k) {
    const int row = int(random() % unsigned(rows)), column = int(random() % unsigned(columns));
    entries.emplace_back(row, column, double(random() % 1000) / 999 - 0.5);
  }
  SparseMatrix out(rows, columns);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

void expect_same_bits(const SparseMatrix& a, const SparseMatrix& b) {
  ASSERT_EQ(a.nonZeros(), b.nonZeros());
  for (Eigen::Index c = 0; c < a.cols(); ++c) {
    SparseMatrix::InnerIterator i(a, c), j(b, c);
    for (; i && j; ++i, ++j) {
      EXPECT_EQ(i.row(), j.row());
      EXPECT_EQ(i.value(), j.value());
    }
    EXPECT_EQ(bool(i), bool(j));
  }
}

TEST(Congruence, HasTheBitsOfWholeProducts) {
  const SparseMatrix j = random_matrix(90, 40, 1), s = random_matrix(90, 90, 2);
  const SparseMatrix transposed = j.transpose(), turned = s * j, plain = transposed * j,
                     with_middle = transposed * turned;
  expect_same_bits(congruence(j.transpose(), nullptr, {}), plain);
  std::vector<Eigen::Triplet<double>> seen;
  const auto see = [&](Index c, Index row, double entry) { seen.emplace_back(row, c, entry); };
  expect_same_bits(congruence(j.transpose(), &s, see), with_middle);
  SparseMatrix as_seen(90, 40);
  as_seen.setFromTriplets(seen.begin(), seen.end());
  expect_same_bits(as_seen, turned);
}

// Its transposed copy and the result are counted, and given back.
TEST(Congruence, CountsItsBytes) {
  const SparseMatrix j = random_matrix(90, 40, 1);
  const MemoryLedger ledger;
  const SparseMatrix product = congruence(j.transpose(), nullptr, {});
  EXPECT_EQ(ledger.peak(), matrix_bytes(j) + matrix_bytes(product));
  EXPECT_EQ(ledger.current(), 0u);
}

}  // namespace
}  // namespace fairing
