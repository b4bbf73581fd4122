// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "solver/assembled_system.h"

namespace fairing {

// P A Pᵀ = L D Lᵀ of a sparse symmetric matrix, row by row [Davis 2005, LDL]. What Eigen::SimplicialLDLT does, to the
// last bit, but a run can be cancelled while it lasts.
class SparseLdlt {
 public:
  // Of the lower triangle. False: the matrix is not positive definite, and there is no factor.
  bool factor(const SparseMatrix& matrix);
  // A⁻¹ b, column by column.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  // Entries of L under its diagonal.
  std::size_t nonzeros() const { return std::size_t(lower_.nonZeros()); }

 private:
  using Upper = Eigen::SparseMatrix<double>;
  using Ids = std::vector<int>;

  void order(const SparseMatrix& matrix, Upper& ordered);
  // The elimination tree, and room for the columns of L.
  Ids find_structure(const Upper& ordered);
  bool find_values(const Upper& ordered, const Ids& parent);

  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation_;
  Eigen::SparseMatrix<double> lower_;
  Eigen::VectorXd diagonal_;
};

}  // namespace fairing
