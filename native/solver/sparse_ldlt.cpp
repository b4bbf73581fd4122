// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sparse_ldlt.h"

#include <Eigen/OrderingMethods>

#include "execution/cancel.h"

namespace fairing {

bool SparseLdlt::factor(const SparseMatrix& matrix) {
  Upper ordered(matrix.rows(), matrix.cols());
  order(matrix, ordered);
  const Ids parent = find_structure(ordered);
  return find_values(ordered, parent);
}

void SparseLdlt::order(const SparseMatrix& matrix, Upper& ordered) {
  stop_if_cancelled();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
  const Upper whole = matrix.selfadjointView<Eigen::Lower>();
  Eigen::AMDOrdering<int>()(whole, inverse);
  stop_if_cancelled();
  permutation_ = inverse.inverse();
  ordered.selfadjointView<Eigen::Upper>() = matrix.selfadjointView<Eigen::Lower>().twistedBy(permutation_);
}

SparseLdlt::Ids SparseLdlt::find_structure(const Upper& ordered) {
  const int size = int(ordered.rows());
  Ids parent(std::size_t(size), -1), seen(std::size_t(size), -1), count(std::size_t(size), 0);
  for (int k = 0; k < size; ++k) {
    stop_if_cancelled(std::size_t(k));
    seen[std::size_t(k)] = k;
    for (Upper::InnerIterator entry(ordered, k); entry; ++entry)
      for (auto i = std::size_t(entry.index()); int(i) < k && seen[i] != k; i = std::size_t(parent[i])) {
        if (parent[i] < 0) parent[i] = k;
        ++count[i];
        seen[i] = k;
      }
  }
  lower_.resize(size, size);
  int* begin = lower_.outerIndexPtr();
  begin[0] = 0;
  for (int k = 0; k < size; ++k) begin[k + 1] = begin[k] + count[std::size_t(k)];
  lower_.resizeNonZeros(begin[size]);
  return parent;
}

bool SparseLdlt::find_values(const Upper& ordered, const Ids& parent) {
  const int size = int(ordered.rows());
  const int* begin = lower_.outerIndexPtr();
  int* row = lower_.innerIndexPtr();
  double* value = lower_.valuePtr();
  diagonal_.resize(size);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(size);
  Ids pattern(std::size_t(size), 0), path(std::size_t(size), 0), seen(std::size_t(size), -1),
      end(begin, begin + size);
  for (int k = 0; k < size; ++k) {
    stop_if_cancelled();
    // The columns that row k of L has entries in, descendants before ancestors.
    auto top = std::size_t(size);
    seen[std::size_t(k)] = k;
    for (Upper::InnerIterator entry(ordered, k); entry; ++entry) {
      auto i = std::size_t(entry.index());
      if (int(i) > k) continue;
      y[entry.index()] += entry.value();
      std::size_t length = 0;
      for (; seen[i] != k; i = std::size_t(parent[i])) {
        path[length++] = int(i);
        seen[i] = k;
      }
      while (length > 0) pattern[--top] = path[--length];
    }
    double d = y[k];
    y[k] = 0;
    for (; top < std::size_t(size); ++top) {
      const int i = pattern[top];
      const double y_i = y[i], l_ki = y_i / diagonal_[i];
      y[i] = 0;
      int& last = end[std::size_t(i)];
      for (int p = begin[i]; p < last; ++p) y[row[p]] -= value[p] * y_i;
      d -= l_ki * y_i;
      row[last] = k;
      value[last++] = l_ki;
    }
    if (!(d > 0)) return false;
    diagonal_[k] = d;
  }
  return true;
}

Eigen::MatrixXd SparseLdlt::solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = permutation_ * b;
  lower_.triangularView<Eigen::UnitLower>().solveInPlace(x);
  x = diagonal_.asDiagonal().inverse() * x;
  lower_.adjoint().triangularView<Eigen::UnitUpper>().solveInPlace(x);
  return permutation_.inverse() * x;
}

}  // namespace fairing
