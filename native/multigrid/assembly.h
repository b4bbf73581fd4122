// SPDX-License-Identifier: GPL-3.0-or-later
// A level's K = J^T S J as a matrix in double, for a direct solve, from three rows of J a point over
// the unknowns of its ring.
#pragma once

#include <functional>
#include <vector>

#include "grid/grid_level.h"
#include "multigrid/level_operator.h"
#include "parallel/memory.h"

namespace fairing {

using Triplets = std::vector<Eigen::Triplet<double>>;

// Those of a matrix, which is no Array, for as long as this lives.
class MatrixBytes : public CountedBytes {
 public:
  explicit MatrixBytes(const SparseMatrix& matrix) : CountedBytes(matrix_bytes(matrix)) {}
};

// Called for the entries of S J, column by column, from which rows may be read.
using TurnedEntry = std::function<void(Index column, Index row, double entry)>;

// J^T S J from `rows`, which is J^T, a column at a time: as a whole S J has several times the numbers
// of J. `middle`: S, or null for J^T J. Sums are taken in the order of Eigen's products.
SparseMatrix congruence(const SparseMatrix& rows, const SparseMatrix* middle,
                        const TurnedEntry& take_turned);

// A point's rows: its ring, and three numbers a point of the ring. None of both: it has no rows.
using TakeRows =
    std::function<void(const std::vector<Index>& ring, const std::vector<double>& numbers)>;

// K of the points that are numbered (number_unknowns()). `visit` hands over the rows of all points in
// order; `middle`: S, 3 rows and columns a point, or null.
AssembledSystem assemble_square(const GridLevel& grid, const std::vector<Index>& number,
                                const SparseMatrix* middle,
                                const std::function<void(const TakeRows&)>& visit);

// Adds to K what does not come from rows.
void add_entries(const Triplets& entries, AssembledSystem& system);

}  // namespace fairing
