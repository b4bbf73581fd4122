// SPDX-License-Identifier: GPL-3.0-or-later
// Least squares with a matrix of which some combinations of columns are almost zero.
#pragma once

#include <Eigen/SparseCore>

namespace fairing {

// x with A x = `right`, by conjugate gradients on the normal equations. They end at `steps`, or where
// the residual is `share` of the right side: before components that A hardly sees grow.
Eigen::VectorXd damped_solution(const Eigen::SparseMatrix<double, Eigen::RowMajor>& a,
                                const Eigen::VectorXd& right, int steps, double share);

}  // namespace fairing
