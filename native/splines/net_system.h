// SPDX-License-Identifier: GPL-3.0-or-later
// The normal equations of a patch's inside, with its outermost control points known.
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
  // Adds scale² |third differences of the net|².
  void add_third_differences(double scale);
  // False where the equations have no solution; the patch stays then.
  bool solve(SplinePatch& patch) const;

 private:
  // Of the unknowns, by control points; -1: known.
  Eigen::Index unknown(int i, int j) const {
    if (i == 0 || j == 0 || i == rows_ - 1 || j == columns_ - 1) return -1;
    return Eigen::Index(i - 1) * (columns_ - 2) + j - 1;
  }

  const SplinePatch& known_;
  int rows_, columns_;
  Eigen::MatrixXd matrix_;  // its lower half
  Eigen::VectorXd right_;
};

}  // namespace fairing
