// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/net_system.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace fairing {

NetSystem::NetSystem(const SplinePatch& known)
    : known_(known), rows_(control_points(known.spans_u)), columns_(control_points(known.spans_v)) {
  width_ = 3 * Eigen::Index(std::min(rows_, columns_) - 2);
  const Eigen::Index size = width_ * (std::max(rows_, columns_) - 2);
  band_.setZero(size, (degree + 1) * width_);
  right_ = balance_ = Eigen::VectorXd::Zero(size);
}

void NetSystem::add(std::span<const NetTerm> terms, const Eigen::Matrix3d& weight,
                    const Vec3& target) {
  struct Unknown {
    Eigen::Index at, shift;
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
      of[count++] = {3 * at, (degree - 3 * at / width_) * width_, term.factor};
  }
  const Vec3 load = weight * rest;
  for (std::size_t a = 0; a < count; ++a) {
    right_.segment<3>(of[a].at) += of[a].factor * load;
    for (std::size_t b = 0; b <= a; ++b) {
      const double both = of[a].factor * of[b].factor;
      const auto& [row, column] =
          of[a].at > of[b].at ? std::tie(of[a], of[b]) : std::tie(of[b], of[a]);
      band_.block<3, 3>(row.at, column.at + row.shift) += both * weight;
    }
  }
}

void NetSystem::add(const CubicBasis& u, const CubicBasis& v, const Eigen::Matrix3d& weight,
                    const Vec3& target) {
  const bool rows_are_blocks = columns_ <= rows_;
  const CubicBasis &slow = rows_are_blocks ? u : v, &fast = rows_are_blocks ? v : u;
  const int slows = rows_are_blocks ? rows_ : columns_, fasts = rows_are_blocks ? columns_ : rows_;
  Vec3 rest = target;
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) {
      const int i = u.first + a, j = v.first + b;
      if (unknown(i, j) < 0) rest -= u.value[a] * v.value[b] * known_.net[known_.index(i, j)];
    }
  const Vec3 load = weight * rest;
  // Without the outermost control points.
  const int slow_from = slow.first ? 0 : 1, slow_to = std::min(4, slows - 1 - slow.first),
            fast_from = fast.first ? 0 : 1, fast_to = std::min(4, fasts - 1 - fast.first);
  const Eigen::Index first = 3 * (fast.first + fast_from - 1), count = 3 * (fast_to - fast_from);
  Eigen::Matrix<double, 3, 12, Eigen::RowMajor> along;  // weight times the fast functions
  for (int m = fast_from; m < fast_to; ++m)
    along.block<3, 3>(0, 3 * (m - fast_from)) = fast.value[m] * weight;
  for (int a = slow_from; a < slow_to; ++a)
    for (int m = fast_from; m < fast_to; ++m) {
      const Eigen::Index row = (slow.first + a - 1) * width_ + 3 * (fast.first + m - 1);
      const double factor = slow.value[a] * fast.value[m];
      right_.segment<3>(row) += factor * load;
      for (int b = slow_from; b <= a; ++b) {
        const Eigen::Index column = (degree + b - a) * width_ + first;
        const double both = factor * slow.value[b];
        for (Eigen::Index c = 0; c < 3; ++c) {
          double* to = &band_(row + c, column);
          const double* from = &along(c, 0);
          for (Eigen::Index k = 0; k < count; ++k) to[k] += both * from[k];
        }
      }
    }
}

void NetSystem::balance(std::span<const NetTerm> terms, const Vec3& weight, const Vec3& target) {
  weighed_ += weight.norm();
  rest_ += weight.dot(target);
  for (const NetTerm& term : terms) {
    const Eigen::Index at = unknown(term.i, term.j);
    if (at < 0)
      rest_ -= term.factor * weight.dot(known_.net[known_.index(term.i, term.j)]);
    else
      balance_.segment<3>(3 * at) += term.factor * weight;
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

// Cholesky factorization by rows of blocks.
bool NetSystem::factor() {
  const Eigen::Index blocks = band_.rows() / width_;
  for (Eigen::Index i = 0; i < blocks; ++i) {
    const Eigen::Index first = std::max<Eigen::Index>(0, i - degree);
    for (Eigen::Index k = first; k < i; ++k) {
      auto below = block(i, k);
      for (Eigen::Index m = first; m < k; ++m)
        below.noalias() -= block(i, m) * block(k, m).transpose();
      block(k, k).triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
    }
    Eigen::MatrixXd own = block(i, i);
    for (Eigen::Index m = first; m < i; ++m)
      own.selfadjointView<Eigen::Lower>().rankUpdate(block(i, m), -1);
    const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factored(own);
    if (factored.info() != Eigen::Success) return false;
    block(i, i) = factored.matrixLLT();
  }
  return true;
}

void NetSystem::substitute(Eigen::VectorXd& x) {
  const Eigen::Index blocks = band_.rows() / width_;
  const auto part = [&](Eigen::Index i) { return x.segment(i * width_, width_); };
  for (Eigen::Index i = 0; i < blocks; ++i) {
    auto own = part(i);
    for (Eigen::Index m = std::max<Eigen::Index>(0, i - degree); m < i; ++m)
      own.noalias() -= block(i, m) * part(m);
    block(i, i).triangularView<Eigen::Lower>().solveInPlace(own);
  }
  for (Eigen::Index i = blocks; i-- > 0;) {
    auto own = part(i);
    for (Eigen::Index m = i + 1; m <= std::min(blocks - 1, i + degree); ++m)
      own.noalias() -= block(m, i).transpose() * part(m);
    block(i, i).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
}

bool NetSystem::solve(SplinePatch& patch, double most_balanced) {
  if (!factor()) return false;
  substitute(right_);
  const double off = rest_ - balance_.dot(right_);
  if (weighed_ > 0 && std::abs(off) <= most_balanced * weighed_) {
    Eigen::VectorXd moved = balance_;  // the smallest change of the unconstrained solution
    substitute(moved);
    right_ += off / balance_.dot(moved) * moved;
  }
  if (!right_.allFinite()) return false;
  for (int i = 1; i + 1 < rows_; ++i)
    for (int j = 1; j + 1 < columns_; ++j)
      patch.net[patch.index(i, j)] = right_.segment<3>(3 * unknown(i, j));
  return true;
}

}  // namespace fairing
