// SPDX-License-Identifier: GPL-3.0-or-later
// fit() (stencil/fit.h) for rings that do not determine a quadratic: two stages.
#pragma once

#include "stencil/fit.h"

namespace fairing {

// The rows of fit() from the basis at the neighbours (one row each, five columns): first the
// `leading` columns alone, by least squares; then, from their remainder, the others with least
// norm.
FitRows staged_fit(const Eigen::MatrixXd& basis, int leading);

// The last three coefficients of the same fit with three leading columns, over a closed ring, by
// normal equations.
class StagedHessian {
 public:
  explicit StagedHessian(std::span<const Vec2> ring);

  // From differences, one per neighbour. Zero for a ring without extent.
  Vec3 operator()(std::span<const double> difference) const;
  // For a one at this neighbour and zeros at all others.
  Vec3 of_neighbour(std::size_t j) const;

 private:
  Coefficients basis_at(std::size_t j) const;
  Vec3 solve(const Coefficients& moment) const;

  std::span<const Vec2> ring_;
  double radius_ = 0;
  Eigen::Matrix3d first_;
  Eigen::Matrix<double, 3, 2> mixed_;
  Eigen::Matrix2d left_inverse_;
};

}  // namespace fairing
