// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/net_system.h"

#include <Eigen/Cholesky>
#include <array>

namespace fairing {

NetSystem::NetSystem(const SplinePatch& known)
    : known_(known), rows_(control_points(known.spans_u)), columns_(control_points(known.spans_v)) {
  const Eigen::Index size = 3 * Eigen::Index(rows_ - 2) * (columns_ - 2);
  matrix_ = Eigen::MatrixXd::Zero(size, size);
  right_ = Eigen::VectorXd::Zero(size);
}

void NetSystem::add(std::span<const NetTerm> terms, const Eigen::Matrix3d& weight,
                    const Vec3& target) {
  struct Unknown {
    Eigen::Index at;
    double factor;
  };
  std::array<Unknown, 16> of;
  std::size_t count = 0;
  Vec3 rest = target;
  for (const NetTerm& term : terms) {
    const Eigen::Index at = unknown(term.i, term.j);
    if (at < 0)
      rest -= term.factor * known_.net[known_.index(term.i, term.j)];
    else
      of[count++] = {3 * at, term.factor};
  }
  const Vec3 load = weight * rest;
  for (std::size_t a = 0; a < count; ++a) {
    right_.segment<3>(of[a].at) += of[a].factor * load;
    for (std::size_t b = 0; b <= a; ++b) {  // terms come in ascending order
      const double both = of[a].factor * of[b].factor;
      matrix_.block<3, 3>(of[a].at, of[b].at) += both * weight;
    }
  }
}

void NetSystem::add_third_differences(double scale) {
  const Eigen::Matrix3d weight = scale * scale * Eigen::Matrix3d::Identity();
  const auto add_row = [&](int i, int j, int di, int dj) {
    add(std::array<NetTerm, 4>{{{i, j, -1},
                                {i + di, j + dj, 3},
                                {i + 2 * di, j + 2 * dj, -3},
                                {i + 3 * di, j + 3 * dj, 1}}},
        weight, Vec3::Zero());
  };
  for (int i = 0; i < rows_; ++i)
    for (int j = 0; j < columns_; ++j) {
      if (i + 3 < rows_) add_row(i, j, 1, 0);
      if (j + 3 < columns_) add_row(i, j, 0, 1);
    }
}

bool NetSystem::solve(SplinePatch& patch) const {
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factored(matrix_);
  if (factored.info() != Eigen::Success) return false;
  const Eigen::VectorXd found = factored.solve(right_);
  if (!found.allFinite()) return false;
  for (int i = 1; i + 1 < rows_; ++i)
    for (int j = 1; j + 1 < columns_; ++j)
      patch.net[patch.index(i, j)] = found.segment<3>(3 * unknown(i, j));
  return true;
}

}  // namespace fairing
