// SPDX-License-Identifier: GPL-3.0-or-later
#include "difference/fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <numbers>

namespace fairing {
namespace {

using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;

constexpr double half_root_half = std::numbers::sqrt2 / 4;  // 1 / (2 sqrt 2)
constexpr double root_half = std::numbers::sqrt2 / 2;

// Below this share of the largest singular value a direction counts as undetermined: what it would add is noise.
constexpr double undetermined = 3e-3;

Columns pseudo_inverse(const Columns& a) {
  Eigen::JacobiSVD<Columns> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const auto& sigma = svd.singularValues();
  const double least = undetermined * (sigma.size() ? std::max(sigma(0), 1e-12) : 0.0);
  Columns middle = svd.matrixU().adjoint();
  for (Eigen::Index k = 0; k < sigma.size(); ++k) middle.row(k) *= sigma(k) > least ? 1 / sigma(k) : 0.0;
  return svd.matrixV() * middle;
}

// First the leading columns alone; then, from what they leave over, the others with least norm.
FitRows staged_fit(const Columns& a, int leading) {
  const Columns first = a.leftCols(leading), second = a.rightCols(5 - leading);
  const Columns first_inverse = pseudo_inverse(first);
  const Columns rest = second - first * (first_inverse * second);
  // `rest` is compared with `second`: where nothing is left, its own largest singular value is noise.
  Columns guarded = rest;
  for (Eigen::Index c = 0; c < guarded.cols(); ++c)
    if (guarded.col(c).norm() < undetermined * second.norm()) guarded.col(c).setZero();
  const Columns second_rows = pseudo_inverse(guarded);
  FitRows rows(5, a.rows());
  rows.bottomRows(5 - leading) = second_rows;
  rows.topRows(leading) = first_inverse - first_inverse * second * second_rows;
  return rows;
}

// Least squares after the ring has been made round: quadratics are invariant under linear maps, so the fit is the
// same, and its normal equations are well-conditioned for any skew. Empty when undetermined.
bool round_fit(const std::vector<Vec2>& ring, FitRows& rows) {
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (const Vec2& p : ring) moment += p * p.transpose();
  moment /= double(ring.size());
  const Eigen::LLT<Eigen::Matrix2d> root(moment);
  if (root.info() != Eigen::Success) return false;
  const Eigen::Matrix2d l = root.matrixL();
  if (!(l(0, 0) > 0) || !(l(1, 1) > 1e-12 * l(0, 0))) return false;
  const Eigen::Matrix2d w = l.inverse();
  FitRows a(5, Eigen::Index(ring.size()));
  for (std::size_t j = 0; j < ring.size(); ++j) a.col(Eigen::Index(j)) = basis(w * ring[j]);
  Eigen::Matrix<double, 5, 5> gram = a * a.transpose();
  const Coefficients scale = gram.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0)) return false;
  gram = scale.cwiseInverse().asDiagonal() * gram * scale.cwiseInverse().asDiagonal();
  const Eigen::LLT<Eigen::Matrix<double, 5, 5>> factor(gram);
  if (factor.info() != Eigen::Success) return false;
  const Eigen::Matrix<double, 5, 5> lower = factor.matrixL();
  if (lower.diagonal().minCoeff() < undetermined) return false;
  a = scale.cwiseInverse().asDiagonal() * a;
  factor.solveInPlace(a);
  a = scale.cwiseInverse().asDiagonal() * a;
  // Back: gradient w^T g, Hessian w^T H w, column by column.
  rows.resize(5, a.cols());
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    const auto c = a.col(j);
    Eigen::Matrix2d h;
    h << root_half * (c(2) + c(3)), root_half * c(4), root_half * c(4), root_half * (c(2) - c(3));
    h = w.transpose() * h * w;
    rows.col(j).head<2>() = w.transpose() * c.head<2>();
    rows(2, j) = root_half * (h(0, 0) + h(1, 1));
    rows(3, j) = root_half * (h(0, 0) - h(1, 1));
    rows(4, j) = std::numbers::sqrt2 * h(0, 1);
  }
  return true;
}

}  // namespace

Coefficients basis(const Vec2& p) {
  const double u = p.x(), v = p.y();
  Coefficients c;
  c << u, v, half_root_half * (u * u + v * v), half_root_half * (u * u - v * v), root_half * u * v;
  return c;
}

FitRows fit(const Chart& chart) {
  const auto n = Eigen::Index(chart.ring.size());
  FitRows rows;
  if (n >= 5 && round_fit(chart.ring, rows)) return rows;
  double radius = 0;
  for (const Vec2& p : chart.ring) radius += p.norm() / double(n);
  Columns a(n, 5);
  for (Eigen::Index j = 0; j < n; ++j) a.row(j) = basis(chart.ring[std::size_t(j)] / radius).transpose();
  rows = staged_fit(a, chart.closed ? 3 : 2);
  rows.topRows(2) /= radius;
  rows.bottomRows(3) /= radius * radius;
  return rows;
}

}  // namespace fairing
