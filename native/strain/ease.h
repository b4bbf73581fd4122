// SPDX-License-Identifier: GPL-3.0-or-later
// Easing: control positions whose loads are small, near where they were. With the loads g that the
// positions ask for and the matrix G of what moves change of them, the moves d of amount s are the
//
//   minimum of  s^2 |g + G d|^2 + |d|^2,   d = -s^2 (I + s^2 G'G)^-1 G'g,                    (*)
//
// a Butterworth filter of the positions where G is symmetric: shapes pass, noise does not. All
// amounts are judged together, by the eigenvalues of G'G: all of them where there are few unknowns,
// otherwise by those of Lanczos' steps (Golub and Meurant 2010, Matrices, Moments and Quadrature).
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "base/types.h"

namespace fairing {

using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;
using LoadMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, Index>;

// The system (*) of some unknowns.
class EaseSystem {
 public:
  // g: one row a load, one column an unknown.
  EaseSystem(LoadMatrix g, Columns loads);

  Eigen::Index unknowns() const { return g_.cols(); }
  // The root mean square of G's eigenvalues, where it is symmetric; 1 over it is a unit of s.
  double mean() const { return mean_; }

  // d of (*) with the loads at hand.
  Columns moves(double s) const;
  // The same with every |d_j| <= bounds_j: the minimum of (*) under that, by alternating directions
  // of multipliers (Boyd and others 2011), all bounds kept to the last bit.
  Columns moves_within(double s, const Eigen::VectorXd& bounds) const;

  // |d|^2; with F = (I + s^2 G'G)^-1 the traces of I - F and of F F.
  double squared_moves(double s) const;
  double trace(double s) const;
  double squared_trace(double s) const;
  // Of the scatter that an amount takes out, root mean square.
  double noise(double s) const;
  // Of scatter as these differences of loads tell it, root mean square; not finite where they tell of
  // none.
  double noise_of(const LoadMatrix& differences) const;
  // Whether what an amount takes out may be scatter: that is in all eigenvectors alike, where shapes
  // that are designed are in few. Always so where eigenvectors are not known.
  bool may_be_scatter(double s) const;

 private:
  // Nodes and weights of a sum over G'G's eigenvalues.
  struct Quadrature {
    std::vector<double> node, weight;
  };
  void find_eigenvalues();
  void probe_eigenvalues();
  Quadrature lanczos(const Eigen::VectorXd& from) const;
  // (shift + 1 + s^2 G'G)^-1 wanted, from `start`.
  Columns solve(double s, double shift, const Columns& wanted, const Columns& start) const;

  LoadMatrix g_, transposed_;
  Columns loads_, pulls_;     // G'g
  Eigen::VectorXd diagonal_;  // of G'G
  Eigen::MatrixXd vectors_;   // of G'G, where all are found
  Eigen::VectorXd values_;
  Quadrature of_pulls_, of_trace_;
  double mean_ = 0;
};

// The amount that robust generalized cross-validation chooses (Lukas 2006): that of Golub, Heath and
// Wahba (1979), with a weight on how much F keeps, as the plain one now and then takes scatter for
// shape where there are few unknowns; where scatter is faint, the smallest of about that score. 0:
// nothing is to be told from the shape, or what would be taken out cannot be scatter.
double cross_validated(const EaseSystem& system);

// The largest amount whose moves are all within bounds, by themselves; a bound of 0 asks for nothing.
double with_moves_within(const EaseSystem& system, const Eigen::VectorXd& bounds);

// The amount s, or the largest below that takes out no more than so much scatter; 0: none does.
double with_noise_up_to(const EaseSystem& system, double s, double noise);

}  // namespace fairing
