// SPDX-License-Identifier: GPL-3.0-or-later
// The normal equations of a patch's inside, with its outermost control points known: a band of
// blocks.
#pragma once

#include <Eigen/Core>
#include <span>

#include "splines/spline.h"

namespace fairing {

struct NetTerm {
  int i, j;
  double factor;
};

class NetSystem {
 public:
  explicit NetSystem(const SplinePatch& known);

  // Adds |weight^(1/2) (sum of factor * control point - target)|².
  void add(std::span<const NetTerm> terms, const Eigen::Matrix3d& weight, const Vec3& target);
  // The same of the patch's point at (u, v).
  void add(const CubicBasis& u, const CubicBasis& v, const Eigen::Matrix3d& weight,
           const Vec3& target);
  // Adds weight · (sum of factor * control point - target) to what is to be zero in all.
  void balance(std::span<const NetTerm> terms, const Vec3& weight, const Vec3& target);
  // Adds scale² |third differences of the net|².
  void add_third_differences(double scale);
  // False where the equations have no solution; the patch stays then. Call it once: it factors the
  // equations in their place. What is to be zero is, unless it is more than `most_balanced` for
  // each unit of weight.
  bool solve(SplinePatch& patch, double most_balanced);

 private:
  // Of the unknowns, by control points; -1: known. The shorter rows make the narrower band.
  Eigen::Index unknown(int i, int j) const {
    if (i == 0 || j == 0 || i == rows_ - 1 || j == columns_ - 1) return -1;
    return columns_ <= rows_ ? Eigen::Index(i - 1) * (columns_ - 2) + j - 1
                             : Eigen::Index(j - 1) * (rows_ - 2) + i - 1;
  }
  // Blocks are rows of control points; each meets itself and three before it.
  auto block(Eigen::Index row, Eigen::Index column) {
    return band_.block(row * width_, (degree + column - row) * width_, width_, width_);
  }
  bool factor();
  void substitute(Eigen::VectorXd& x);

  static constexpr Eigen::Index degree = 3;
  const SplinePatch& known_;
  int rows_, columns_;
  Eigen::Index width_;  // of a block
  // The lower half, block beside block; samples add to rows of it.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> band_;
  Eigen::VectorXd right_, balance_;
  double rest_ = 0, weighed_ = 0;  // what the unknowns have to balance; all weights
};

}  // namespace fairing
