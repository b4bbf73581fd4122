// SPDX-License-Identifier: GPL-3.0-or-later
// The solver's interface to an energy on one level: the action of its matrix K and the diagonal. A
// new energy is a new LevelOperator.
#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <vector>

#include "base/types.h"
#include "multigrid/line_band.h"
#include "parallel/memory.h"
#include "parallel/workers.h"

namespace fairing {

// Extra numbers at the end of vectors in single precision: operators may read them in packs.
constexpr std::size_t vector_room = 16;

using SparseMatrix = Eigen::SparseMatrix<double>;
constexpr std::size_t matrix_entry = sizeof(double) + sizeof(int);  // bytes, as stored
inline std::size_t matrix_bytes(const SparseMatrix& matrix) {
  return std::size_t(matrix.nonZeros()) * matrix_entry;
}

// A level's operator as a matrix, for a direct solve.
//
// A ring of n points couples all of them: n^2 numbers. For larger rings its rows u are stored as
// they are, each with an auxiliary unknown z = u . x behind the others:
//
//   K = A + u u^T - w w^T   is the Schur complement of   A  u  w
//                                                        u -1  0
//                                                        w  0  1
constexpr std::size_t most_coupled = 64;

struct AssembledSystem {
  SparseMatrix matrix;                // both triangles stored; without auxiliary unknowns it is K
  std::vector<Index> unknown_points;  // row -> point of the grid; auxiliary rows have none
  Index negative = 0;                 // auxiliary unknowns with -1 on the diagonal

  // Of K, or somewhat more: the squares of w are added.
  Eigen::VectorXd diagonal() const {
    const auto unknowns = Eigen::Index(unknown_points.size());
    Eigen::VectorXd out = matrix.diagonal().head(unknowns);
    for (Eigen::Index c = unknowns; c < matrix.cols(); ++c)
      for (SparseMatrix::InnerIterator entry(matrix, c); entry && entry.row() < unknowns; ++entry)
        out(entry.row()) += entry.value() * entry.value();
    return out;
  }
};

// Counts the changes of an operator; cached data are valid for one count.
struct OperatorVersion {
  int numbers = 0;   // of K
  int spectrum = 0;  // changes of K that change its largest eigenvalue
  int unknowns = 0;  // which points are unknowns
};

// A symmetric positive definite operator on the unknown points of a level. Vectors hold
// components() interleaved numbers a point, which the operator does not mix: x, y and z, or one
// displacement. Results are zero on points that are not unknowns. All calls throw where the run has
// been cancelled.
class LevelOperator {
 public:
  virtual ~LevelOperator() = default;
  virtual std::size_t points() const = 0;
  virtual std::size_t components() const = 0;
  std::size_t size() const { return components() * points(); }  // of a vector

  // y <- K x. In single precision inside the preconditioner.
  virtual void apply(const double* x, double* y) = 0;
  virtual void apply(const float* x, float* y) = 0;
  virtual const Array<float>& inverse_diagonal() const = 0;

  const OperatorVersion& version() const { return version_; }

  virtual AssembledSystem assemble() const = 0;  // small levels only
  // Calls LineBand::write(). Without that the smoother has no lines.
  virtual void write_lines(LineBand&, Workers&) {}

 protected:
  OperatorVersion version_;  // to be incremented by every change of K
};

}  // namespace fairing
