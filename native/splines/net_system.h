// SPDX-License-Identifier: GPL-3.0-or-later
// The normal equations for the inner control points of a patch with known outermost ones: a band of
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
  // The same for the patch's point at (u, v).
  void add(const CubicBasis& u, const CubicBasis& v, const Eigen::Matrix3d& weight,
           const Vec3& target);
  // Adds weight · (sum of factor * control point - target) to the sum that must vanish.
  void balance(std::span<const NetTerm> terms, const Vec3& weight, const Vec3& target);
  // Adds scale² |third differences of the net|².
  void add_third_differences(double scale);
  // Solves for the inner control points. False if there is no solution; then the patch is
  // unchanged. Factors the equations in place, so call it once. The sum vanishes unless it exceeds
  // `most_balanced` per unit of weight.
  bool solve(SplinePatch& patch, double most_balanced);

 private:
  // Number of the unknown at a control point; -1: known. Blocks are rows in the shorter direction,
  // for a narrower band.
  Eigen::Index unknown(int i, int j) const {
    if (i == 0 || j == 0 || i == rows_ - 1 || j == columns_ - 1) return -1;
    return columns_ <= rows_ ? Eigen::Index(i - 1) * (columns_ - 2) + j - 1
                             : Eigen::Index(j - 1) * (rows_ - 2) + i - 1;
  }
  // Blocks are rows of control points; each is coupled with itself and the three before it.
  auto block(Eigen::Index row, Eigen::Index column) {
    return band_.block(row * width_, (degree + column - row) * width_, width_, width_);
  }
  bool factor();
  void substitute(Eigen::VectorXd& x);

  static constexpr Eigen::Index degree = 3;
  const SplinePatch& known_;
  int rows_, columns_;
  Eigen::Index width_;  // size of a block
  // The lower half, block by block; samples add to its rows.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> band_;
  Eigen::VectorXd right_, balance_;
  double rest_ = 0, weighed_ = 0;  // the remaining sum, and the sum of all weights
};

}  // namespace fairing
