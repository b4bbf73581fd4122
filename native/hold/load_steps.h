// SPDX-License-Identifier: GPL-3.0-or-later
// How the loads on pads are found. B f = r says which loads take the point forces r off the control
// vertices, with B = H^T Omega Phi and H the cardinal surfaces of K (1 at one control vertex, 0 at
// the others); it is close to the hats' mass matrix M (measured: eigenvalues of M^-1 B from 0.2 to
// 1.3). So a surface is solved for with the loads as they are, the forces that are left are read,
// loads take the correction M^-1 r, and Anderson's acceleration makes of these corrections what
// GMRES would.
#pragma once

#include <vector>

#include "hold/anderson.h"
#include "hold/couples.h"

namespace fairing {

// Of what loads carry: the forces that may be left below the finest level, where loads are starts only.
constexpr double coarse_force_tolerance = 2e-2;

template <int N>
double dot(const LoadsOf<N>& a, const LoadsOf<N>& b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) sum += a[v].dot(b[v]);
  return sum;
}

// What holds control vertices: the loads on their pads, what keeps them within bounds, N numbers an
// input vertex, and the couples that fix normals. Any may be empty.
template <int N>
struct Multipliers {
  LoadsOf<N> loads;
  std::vector<double> bounds;
  Moments moments{};
};

// The norm of M for loads; changes of what bounds are compared by `weights`, one each, which make
// them comparable with changes of loads, and so are moments by `mass`. The hats must outlive it; null
// where there are no loads.
template <int N>
struct MultiplierSpace {
  using Vector = Multipliers<N>;

  const Hats* hats;
  std::vector<double> weights;
  Moments mass{};

  Vector product(const Vector& a) const;
  double dot(const Vector& a, const Vector& b) const;
  void add(double factor, const Vector& a, const Vector& b, Vector& to) const;
  void subtract(const Vector& a, Vector& from) const;
};

// Of f <- f + M^-1 r, and of multipliers along with it.
template <int N>
using LoadSteps = Anderson<MultiplierSpace<N>>;

template <int N>
LoadSteps<N> load_steps(const Hats* hats, std::vector<double> weights = {}, Moments mass = {}) {
  return {{hats, std::move(weights), std::move(mass)}, 6};
}

}  // namespace fairing
