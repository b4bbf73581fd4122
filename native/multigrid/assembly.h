// SPDX-License-Identifier: GPL-3.0-or-later
// A level's K = J^T S J as a matrix in double for a direct solve, from the three rows of J of each
// point, over the unknowns of its ring.
#pragma once

#include <functional>
#include <vector>

#include "grid/grid_level.h"
#include "multigrid/level_operator.h"
#include "parallel/memory.h"

namespace fairing {

using Triplets = std::vector<Eigen::Triplet<double>>;

// The bytes of a matrix, which is not an Array, during its lifetime.
class MatrixBytes : public CountedBytes {
 public:
  explicit MatrixBytes(const SparseMatrix& matrix) : CountedBytes(matrix_bytes(matrix)) {}
};

// Receives a point's rows: its ring, and three numbers for each member. Both empty: no rows.
using VisitRows =
    std::function<void(const std::vector<Index>& ring, const std::vector<double>& numbers)>;

// K of the numbered points (number_unknowns()). `visit` passes the rows of all points in order;
// `middle`: S, 3 rows and columns a point, or null.
AssembledSystem assemble_square(const GridLevel& grid, const std::vector<Index>& number,
                                const SparseMatrix* middle,
                                const std::function<void(const VisitRows&)>& visit);

// Adds entries that do not come from rows.
void add_entries(const Triplets& entries, AssembledSystem& system);

}  // namespace fairing
