// SPDX-License-Identifier: GPL-3.0-or-later
// J^T S J, a column at a time: the product S J has several times the numbers of J, and as a whole,
// with what Eigen's products copy, it was most of the memory of a run whose level is factored.
#pragma once

#include <functional>

#include "multigrid/level_operator.h"
#include "parallel/memory.h"

namespace fairing {

// Those of a matrix, which is no Array, for as long as this lives.
class MatrixBytes : public CountedBytes {
 public:
  explicit MatrixBytes(const SparseMatrix& matrix) : CountedBytes(matrix_bytes(matrix)) {}
};

// Called for the entries of S J, column by column, from which rows may be read.
using TurnedEntry = std::function<void(Index column, Index row, double entry)>;

// `middle`: S, or null for J^T J. Sums are taken in the order of Eigen's products.
SparseMatrix congruence(const SparseMatrix& jacobian, const SparseMatrix* middle,
                        const TurnedEntry& take_turned);

}  // namespace fairing
