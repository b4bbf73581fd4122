// SPDX-License-Identifier: GPL-3.0-or-later
// How the loads on pads are found. B f = r gives the loads that remove the point forces r from the
// control vertices, with B = H^T Omega Phi and H the cardinal surfaces of K (1 at one control
// vertex, 0 at the others). B is close to the hats' mass matrix M (measured: eigenvalues of M^-1 B
// from 0.2 to 1.3). So a surface is solved for with the current loads, the remaining forces are
// read, the loads are corrected by M^-1 r, and Anderson's acceleration makes this equivalent to
// GMRES.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "constraints/anderson.h"
#include "constraints/couples.h"

namespace fairing {

// Force that may be left below the finest level, where loads are only starts; relative to the
// loads.
constexpr double coarse_force_tolerance = 2e-2;

template <int N>
double dot(const LoadsOf<N>& a, const LoadsOf<N>& b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) sum += a[v].dot(b[v]);
  return sum;
}

// The multipliers: the loads on pads, those of tolerances (shifts of targets, N numbers an input
// vertex, or ends of intervals, one each), and the couples of fixed normals. Any may be empty.
template <int N>
struct Multipliers {
  LoadsOf<N> loads{};
  std::vector<double> bounds{};
  Moments moments{};
};

// All numbers of multipliers, kind by kind.
template <class Of>
auto numbers_of(Of& a) {
  const auto of = [](auto& kind) {
    using Kind = std::remove_reference_t<decltype(kind)>;
    using Number = std::conditional_t<std::is_const_v<Kind>, const double, double>;
    using Entry = typename Kind::value_type;
    return std::span(reinterpret_cast<Number*>(kind.data()),
                     kind.size() * (sizeof(Entry) / sizeof(double)));
  };
  return std::array{of(a.loads), of(a.bounds), of(a.moments)};
}

// The norm of M for loads. Shifts of targets are scaled by `weights`, one each, to be comparable
// with changes of loads, and moments by `mass`. The hats must outlive it; null without loads.
template <int N>
struct MultiplierSpace {
  using Vector = Multipliers<N>;

  const Hats* hats;
  std::vector<double> weights;
  Moments mass{};

  Vector product(const Vector& a) const {
    Vector out{{}, a.bounds, a.moments};
    if (hats) hats->multiply_mass<N>(a.loads, out.loads);
    for (std::size_t v = 0; v < out.bounds.size(); ++v) out.bounds[v] *= weights[v];
    for (std::size_t c = 0; c < out.moments.size(); ++c)
      out.moments[c] = mass[c].cwiseProduct(a.moments[c]);
    return out;
  }
  double dot(const Vector& a, const Vector& b) const {
    double sum = 0;
    const auto x = numbers_of(a), y = numbers_of(b);
    for (std::size_t kind = 0; kind < x.size(); ++kind)
      for (std::size_t i = 0; i < x[kind].size(); ++i) sum += x[kind][i] * y[kind][i];
    return sum;
  }
  void add(double factor, const Vector& a, const Vector& b, Vector& to) const {
    const auto x = numbers_of(a), y = numbers_of(b);
    const auto sum = numbers_of(to);
    for (std::size_t kind = 0; kind < x.size(); ++kind)
      for (std::size_t i = 0; i < sum[kind].size(); ++i)
        sum[kind][i] += factor * (x[kind][i] + y[kind][i]);
  }
  void subtract(const Vector& a, Vector& from) const {
    const auto x = numbers_of(a);
    const auto left = numbers_of(from);
    for (std::size_t kind = 0; kind < x.size(); ++kind)
      for (std::size_t i = 0; i < left[kind].size(); ++i) left[kind][i] -= x[kind][i];
  }
};

// Accelerates f <- f + M^-1 r, together with the other multipliers.
template <int N>
using MultiplierSteps = Anderson<MultiplierSpace<N>>;

template <int N>
MultiplierSteps<N> multiplier_steps(const Hats* hats, std::vector<double> weights = {},
                                    Moments mass = {}) {
  return {{hats, std::move(weights), std::move(mass)}, 6};
}

}  // namespace fairing
