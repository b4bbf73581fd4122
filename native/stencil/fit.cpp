// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numbers>

#include "stencil/whitened_fit.h"

namespace fairing {
namespace {

constexpr double half_root_half = std::numbers::sqrt2 / 4;  // 1 / (2 sqrt 2)

using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 5, 5>;

// The pseudo-inverse of a positive semidefinite matrix, without the directions whose eigenvalues
// are a small share of the largest, or of `scale` if that is larger.
SmallMatrix pseudo_inverse(const SmallMatrix& gram, double scale = 0) {
  const Eigen::SelfAdjointEigenSolver<SmallMatrix> eigen(gram);
  const double least = undetermined_square * std::max(eigen.eigenvalues().maxCoeff(), scale);
  const auto inverse = eigen.eigenvalues().unaryExpr(
      [least](double value) { return value > least ? 1 / value : 0.0; });
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

// The rows of fit() in two stages: first the `leading` coefficients alone, by least squares; then,
// from the remainder, the others with least norm. Zero for a ring without extent.
FitRows staged_fit(std::span<const Vec2> ring, Eigen::Index leading) {
  const auto size = Eigen::Index(ring.size()), others = 5 - leading;
  FitRows rows = FitRows::Zero(5, size);
  double radius = 0;
  for (const Vec2& p : ring) radius += p.norm() / double(size);
  if (!(radius > 0)) return rows;
  FitRows terms(5, size);
  for (Eigen::Index j = 0; j < size; ++j) terms.col(j) = basis(ring[std::size_t(j)] / radius);
  const SmallMatrix gram = terms * terms.transpose();
  const SmallMatrix first = pseudo_inverse(gram.topLeftCorner(leading, leading));
  const SmallMatrix mixed = first * gram.topRightCorner(leading, others);
  // The remainder is compared with the terms themselves: if it is zero, its own largest eigenvalue
  // is noise. All terms together, since rotations of the chart mix them.
  const SmallMatrix rest =
      gram.bottomRightCorner(others, others) - gram.bottomLeftCorner(others, leading) * mixed;
  rows.bottomRows(others) = pseudo_inverse(rest, gram.bottomRightCorner(others, others).trace()) *
                            (terms.bottomRows(others) - mixed.transpose() * terms.topRows(leading));
  rows.topRows(leading) = first * terms.topRows(leading) - mixed * rows.bottomRows(others);
  rows.topRows(2) /= radius;
  rows.bottomRows(3) /= radius * radius;
  return rows;
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
  Whitened whitened;
  if (!make(chart.ring, {}, whitened)) return staged_fit(chart.ring, chart.closed ? 3 : 2);
  FitRows rows(5, Eigen::Index(chart.ring.size()));
  for (std::size_t j = 0; j < chart.ring.size(); ++j) {
    Whitened::Term sum;
    whitened.add(chart.ring[j].x(), chart.ring[j].y(), 1.0, sum);
    auto row = rows.col(Eigen::Index(j));
    whitened.gradient(sum, row[0], row[1]);
    whitened.hessian(sum, row[2], row[3], row[4]);
  }
  return rows;
}

Vec3 fitted_hessian(std::span<const Vec2> ring, std::span<const double> difference,
                    std::span<const double> weight) {
  Whitened whitened;
  if (!make(ring, weight, whitened))
    return staged_fit(ring, 3).bottomRows<3>() *
           Eigen::Map<const Eigen::VectorXd>(difference.data(), Eigen::Index(difference.size()));
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
  const FitRows staged = staged_fit(ring, 3);
  for (std::size_t j = 0; j < ring.size(); ++j) rows[j] = staged.col(Eigen::Index(j)).tail<3>();
}

}  // namespace fairing
