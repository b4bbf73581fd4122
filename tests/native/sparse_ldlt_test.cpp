// SPDX-License-Identifier: GPL-3.0-or-later
// Our factorization beside Eigen's, which it repeats.
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <random>
#include <tuple>

#include "execution/cancel.h"
#include "solver/sparse_ldlt.h"

namespace fairing::test {
namespace {

// A grid's Laplacian squared, and something on the diagonal.
SparseMatrix plate(int columns, int rows, double diagonal) {
  const int size = columns * rows;
  SparseMatrix laplacian(size, size), identity(size, size);
  std::vector<Eigen::Triplet<double>> entries;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> weight(0.5, 2);
  const auto join = [&](int a, int b) {
    const double w = weight(random);
    for (const auto& [i, j, v] : {std::tuple{a, a, w}, {b, b, w}, {a, b, -w}, {b, a, -w}})
      entries.emplace_back(i, j, v);
  };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      if (c > 0) join(r * columns + c - 1, r * columns + c);
      if (r > 0) join((r - 1) * columns + c, r * columns + c);
    }
  laplacian.setFromTriplets(entries.begin(), entries.end());
  identity.setIdentity();
  return SparseMatrix(laplacian * laplacian) + diagonal * identity;
}

TEST(SparseLdlt, is_eigens_to_the_last_bit) {
  for (const auto& [columns, rows] : {std::pair{1, 1}, {1, 7}, {9, 5}, {40, 30}}) {
    const SparseMatrix matrix = plate(columns, rows, 0.1);
    const Eigen::MatrixXd b = Eigen::MatrixXd::Random(matrix.rows(), 3);
    const Eigen::SimplicialLDLT<SparseMatrix> eigen(matrix);
    SparseLdlt own;
    for (int again = 0; again < 2; ++again) {
      ASSERT_TRUE(own.factor(matrix));
      EXPECT_EQ(own.nonzeros(), std::size_t(eigen.matrixL().nestedExpression().nonZeros()));
      const Eigen::MatrixXd x = own.solve(b), expected = eigen.solve(b);
      EXPECT_TRUE((x.array() == expected.array()).all());
      EXPECT_LT((matrix * x - b).norm(), 1e-9 * b.norm());
    }
  }
}

TEST(SparseLdlt, refuses_what_is_not_positive_definite) {
  SparseLdlt own;
  EXPECT_FALSE(own.factor(plate(9, 5, -0.1)));
  EXPECT_TRUE(own.factor(plate(9, 5, 0.1)));
}

TEST(SparseLdlt, can_be_cancelled_at_each_question_and_used_again) {
  const SparseMatrix matrix = plate(20, 20, 0.1);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(matrix.rows(), 1);
  SparseLdlt fresh, own;
  ASSERT_TRUE(fresh.factor(matrix));
  int stopped = 0;
  for (std::int64_t question = 1;; ++question, ++stopped) {
    Monitor monitor;
    const CancelScope scope(&monitor);
    monitor.cancel_at_question(question);
    try {
      ASSERT_TRUE(own.factor(matrix));
      break;
    } catch (const FairingError& error) {
      ASSERT_EQ(error.code, ErrorCode::cancelled);
    }
  }
  EXPECT_GE(stopped, 400);  // each row
  EXPECT_TRUE((own.solve(b).array() == fresh.solve(b).array()).all());
}

}  // namespace
}  // namespace fairing::test
