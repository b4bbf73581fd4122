// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "stencil/staged_fit.h"
#include "stencil/whitened_fit.h"

namespace fairing {
namespace {

constexpr double half_root_half = std::numbers::sqrt2 / 4;  // 1 / (2 sqrt 2)

// Whether the Cholesky factor of the scaled normal equations determines all coefficients. Rotations
// of the chart mix the last two columns, so the remainder for them is judged by its eigenvalues and
// does not depend on the first neighbour.
bool determines(const Eigen::Matrix<double, 5, 5>& lower, const Coefficients& scale) {
  if (lower.diagonal().head<3>().minCoeff() < undetermined) return false;
  const Eigen::Matrix2d root = scale.tail<2>().asDiagonal() * lower.bottomRightCorner<2, 2>();
  const Eigen::Matrix2d rest = root * root.transpose();
  const double least = 0.5 * undetermined_square * scale.tail<2>().squaredNorm();
  const Eigen::Matrix2d above = rest - least * Eigen::Matrix2d::Identity();
  return above(0, 0) > 0 && above(0, 0) * above(1, 1) > above(0, 1) * above(1, 0);
}

// Least squares after a linear map makes the ring round: quadratics are invariant under linear
// maps, so the fit is the same, and well-conditioned for any skew. Empty if undetermined.
bool whitened_fit(const std::vector<Vec2>& ring, FitRows& rows) {
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (const Vec2& p : ring) moment += p * p.transpose();
  moment /= double(ring.size());
  const Eigen::LLT<Eigen::Matrix2d> root(moment);
  if (root.info() != Eigen::Success) return false;
  const Eigen::Matrix2d l = root.matrixL();
  if (!(l(0, 0) > 0) || !(l(1, 1) > roundoff * l(0, 0))) return false;
  const Eigen::Matrix2d w = l.inverse();
  FitRows a(5, Eigen::Index(ring.size()));
  for (std::size_t j = 0; j < ring.size(); ++j) a.col(Eigen::Index(j)) = basis(w * ring[j]);
  Eigen::Matrix<double, 5, 5> gram = a * a.transpose();
  const Coefficients scale = gram.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0)) return false;
  gram = scale.cwiseInverse().asDiagonal() * gram * scale.cwiseInverse().asDiagonal();
  const Eigen::LLT<Eigen::Matrix<double, 5, 5>> factor(gram);
  if (factor.info() != Eigen::Success) return false;
  if (!determines(factor.matrixL(), scale)) return false;
  a = scale.cwiseInverse().asDiagonal() * a;
  factor.solveInPlace(a);
  a = scale.cwiseInverse().asDiagonal() * a;
  // Maps back: gradient w^T g, Hessian w^T H w, column by column.
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

using Whitened = WhitenedFit<double>;

// False if the ring does not determine a quadratic. Without weights all are one.
bool make(std::span<const Vec2> ring, std::span<const double> weight, Whitened& fit) {
  if (ring.size() < 5) return false;
  bool determined = true;
  const auto neighbour = [&](int j, double& u, double& v, double& w) {
    u = ring[std::size_t(j)].x();
    v = ring[std::size_t(j)].y();
    w = weight.empty() ? 1.0 : weight[std::size_t(j)];
  };
  fit.make(int(ring.size()), neighbour, determined);
  return determined;
}

Vec3 hessian(const Whitened& fit, const Whitened::Term& sum) {
  Vec3 out;
  fit.hessian(sum, out[0], out[1], out[2]);
  return out;
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
  if (n >= 5 && whitened_fit(chart.ring, rows)) return rows;
  double radius = 0;
  for (const Vec2& p : chart.ring) radius += p.norm() / double(n);
  Eigen::MatrixXd a(n, 5);
  for (Eigen::Index j = 0; j < n; ++j)
    a.row(j) = basis(chart.ring[std::size_t(j)] / radius).transpose();
  rows = staged_fit(a, chart.closed ? 3 : 2);
  rows.topRows(2) /= radius;
  rows.bottomRows(3) /= radius * radius;
  return rows;
}

Vec3 fitted_hessian(std::span<const Vec2> ring, std::span<const double> difference,
                    std::span<const double> weight) {
  Whitened whitened;
  if (!make(ring, weight, whitened)) return StagedHessian(ring)(difference);
  Whitened::Term sum;
  for (std::size_t j = 0; j < ring.size(); ++j)
    whitened.add(ring[j].x(), ring[j].y(),
                 weight.empty() ? difference[j] : weight[j] * difference[j], sum);
  return hessian(whitened, sum);
}

void hessian_rows(std::span<const Vec2> ring, std::span<const double> weight,
                  std::vector<Vec3>& rows) {
  rows.resize(ring.size());
  Whitened whitened;
  if (make(ring, weight, whitened)) {
    for (std::size_t j = 0; j < ring.size(); ++j) {
      Whitened::Term sum;
      whitened.add(ring[j].x(), ring[j].y(), weight.empty() ? 1.0 : weight[j], sum);
      rows[j] = hessian(whitened, sum);
    }
    return;
  }
  const StagedHessian staged(ring);
  for (std::size_t j = 0; j < ring.size(); ++j) rows[j] = staged.of_neighbour(j);
}

}  // namespace fairing
