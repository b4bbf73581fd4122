// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/fit.h"

#include <cmath>
#include <numbers>

#include "stencil/staged_fit.h"
#include "stencil/whitened_fit.h"

namespace fairing {
namespace {

constexpr double half_root_half = std::numbers::sqrt2 / 4;  // 1 / (2 sqrt 2)

// Calls set(j, coefficients for a one at neighbour j). False, and calls nothing, if the ring does
// not determine a quadratic. Without weights all are one.
template <class Set>
bool fit_whitened(std::span<const Vec2> ring, std::span<const double> weight, const Set& set) {
  if (ring.size() < 5) return false;
  const auto weight_of = [&](std::size_t j) { return weight.empty() ? 1.0 : weight[j]; };
  WhitenedFit<double> fit;
  bool determined = true;
  const auto neighbour = [&](int j, double& u, double& v, double& w) {
    u = ring[j].x();
    v = ring[j].y();
    w = weight_of(std::size_t(j));
  };
  fit.make(int(ring.size()), neighbour, determined);
  for (std::size_t j = 0; j < ring.size() && determined; ++j) {
    WhitenedFit<double>::Term sum;
    fit.add(ring[j].x(), ring[j].y(), weight_of(j), sum);
    double c[5];
    fit.solve(sum, c);
    set(j, Eigen::Map<const Coefficients>(c));
  }
  return determined;
}

}  // namespace

Coefficients basis(const Vec2& p) {
  const double u = p.x(), v = p.y();
  Coefficients c;
  c << u, v, half_root_half * (u * u + v * v), half_root_half * (u * u - v * v), root_half * u * v;
  return c;
}

FitRows fit(const Chart& chart) {
  FitRows rows(5, Eigen::Index(chart.ring.size()));
  const auto set = [&](std::size_t j, const Coefficients& c) { rows.col(Eigen::Index(j)) = c; };
  if (fit_whitened(chart.ring, {}, set)) return rows;
  return staged_fit(chart.ring, chart.closed ? 3 : 2);
}

void hessian_rows(std::span<const Vec2> ring, std::span<const double> weight,
                  std::vector<Vec3>& rows) {
  rows.resize(ring.size());
  const auto set = [&](std::size_t j, const Coefficients& c) { rows[j] = c.tail<3>(); };
  if (fit_whitened(ring, weight, set)) return;
  const FitRows staged = staged_fit(ring, 3);
  for (std::size_t j = 0; j < ring.size(); ++j) set(j, staged.col(Eigen::Index(j)));
}

}  // namespace fairing
