// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/least_squares.h"

#include <algorithm>
#include <limits>

namespace fairing {

Eigen::VectorXd damped_solution(const Eigen::SparseMatrix<double, Eigen::RowMajor>& a,
                                const Eigen::VectorXd& right, int steps, double share) {
  constexpr double least = std::numeric_limits<double>::min();
  Eigen::VectorXd found = Eigen::VectorXd::Zero(a.cols()), left = right, seen;
  Eigen::VectorXd slope = a.transpose() * left, way = slope;
  const double enough = share * share * right.squaredNorm();
  double slope2 = slope.squaredNorm();
  for (int k = 0; k < steps && left.squaredNorm() > enough; ++k) {
    seen = a * way;
    const double length = slope2 / std::max(seen.squaredNorm(), least);
    found += length * way;
    left -= length * seen;
    slope = a.transpose() * left;
    const double before = std::max(slope2, least);
    slope2 = slope.squaredNorm();
    way = slope + slope2 / before * way;
  }
  return found;
}

}  // namespace fairing
