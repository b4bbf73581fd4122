// SPDX-License-Identifier: GPL-3.0-or-later
// How the loads on pads are found. B f = r gives the loads that remove the point forces r from the
// control vertices, with B = H^T Omega Phi and H the cardinal surfaces of K (1 at one control
// vertex, 0 at the others). B is close to the hats' mass matrix M (measured: eigenvalues of M^-1 B
// from 0.2 to 1.3). So a surface is solved for with the current loads, the remaining forces are
// read, the loads are corrected by M^-1 r, and Anderson's acceleration makes this equivalent to
// GMRES.
#pragma once

#include <vector>

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
template <int N>
Array<double> numbers_of(const Multipliers<N>& multipliers) {
  Array<double> out;
  for (const auto& load : multipliers.loads) out.insert(out.end(), load.begin(), load.end());
  out.insert(out.end(), multipliers.bounds.begin(), multipliers.bounds.end());
  for (const auto& moment : multipliers.moments)
    out.insert(out.end(), moment.begin(), moment.end());
  return out;
}

// As many multipliers as `like` has, from their numbers.
template <int N>
Multipliers<N> multipliers_of(const Array<double>& numbers, const Multipliers<N>& like) {
  Multipliers<N> out = like;
  auto next = numbers.begin();
  for (auto& load : out.loads)
    for (double& number : load) number = *next++;
  for (double& number : out.bounds) number = *next++;
  for (auto& moment : out.moments)
    for (double& number : moment) number = *next++;
  return out;
}

}  // namespace fairing
