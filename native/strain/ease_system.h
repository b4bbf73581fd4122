// SPDX-License-Identifier: GPL-3.0-or-later
// Easing: control positions with small loads, near the given ones. With the loads g of the given
// positions and the matrix G of the loads' changes by moves, the moves d of amount s are the
//
//   minimum of  s^2 |g + G d|^2 + |d|^2,   d = -s^2 (I + s^2 G'G)^-1 G'g,                    (*)
//
// a Butterworth filter of the positions if G is symmetric: it keeps shapes and removes noise. All
// amounts are judged together, by the eigenvalues of G'G: by all of them if there are few unknowns,
// otherwise by those of Lanczos' method (Golub and Meurant 2010, Matrices, Moments and Quadrature).
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "base/types.h"

namespace fairing {

using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;
using LoadMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, Index>;

// The system (*) for a set of unknowns.
class EaseSystem {
 public:
  // g: one row for each load, one column for each unknown.
  EaseSystem(LoadMatrix g, Columns loads);
  // The same system with other loads.
  EaseSystem with_loads(Columns loads) const;
  const LoadMatrix& matrix() const { return g_; }
  const Columns& loads() const { return loads_; }

  Eigen::Index unknowns() const { return g_.cols(); }
  // The root mean square of G's eigenvalues, if it is symmetric; its inverse is the unit of s.
  double mean() const { return mean_; }

  // d of (*).
  Columns moves(double s) const;
  // The same with every |d_j| <= bounds_j: the constrained minimum of (*), by the alternating
  // direction method of multipliers (Boyd and others 2011). Bounds hold to the last bit.
  Columns moves_within(double s, const Eigen::VectorXd& bounds) const;

  // |d|^2; with F = (I + s^2 G'G)^-1 the traces of I - F and of F F.
  double squared_moves(double s) const;
  double trace(double s) const;
  double squared_trace(double s) const;
  // Root mean square of the scatter that an amount removes.
  double noise(double s) const;
  // Whether the part that an amount removes may be scatter: scatter has all eigenvectors alike,
  // designed shapes have few. True if the eigenvectors are not computed.
  bool may_be_scatter(double s) const;

 private:
  // Nodes and weights of a sum over the eigenvalues of G'G.
  struct Quadrature {
    std::vector<double> node, weight;
  };
  void find_eigenvalues();
  void set_loads(Columns loads);
  static void add(const Quadrature& more, double share, Quadrature& all);
  Quadrature lanczos(const Eigen::VectorXd& from) const;
  // (shift + 1 + s^2 G'G)^-1 wanted, iterated from `start`.
  Columns solve(double s, double shift, const Columns& wanted, const Columns& start) const;

  LoadMatrix g_, transposed_;
  Columns loads_, gradient_;  // G'g
  Eigen::VectorXd diagonal_;  // of G'G
  Eigen::MatrixXd vectors_;   // of G'G, if all are computed
  Eigen::VectorXd values_;
  Quadrature of_gradient_, of_trace_;
  double mean_ = 0;
};

// The amount chosen by robust generalized cross-validation (Lukas 2006): the score of Golub, Heath
// and Wahba (1979) with a weight on what F keeps, since with few unknowns the plain score sometimes
// takes scatter for shape. If scatter is faint, the smallest amount with about the least score. 0
// if scatter cannot be distinguished from the shape.
double least_score(const EaseSystem& system);
// The same, and 0 if the removed part cannot be scatter.
double cross_validated(const EaseSystem& system);

// The largest amount whose free moves are within the bounds; a bound of 0 is ignored.
double with_moves_within(const EaseSystem& system, const Eigen::VectorXd& bounds);

// The amount s, or the largest smaller one that removes at most `noise`; 0 if none does.
double with_noise_up_to(const EaseSystem& system, double s, double noise);

}  // namespace fairing
