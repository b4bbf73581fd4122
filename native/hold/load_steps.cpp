// SPDX-License-Identifier: GPL-3.0-or-later
#include "hold/load_steps.h"

namespace fairing {

template <int N>
Multipliers<N> MultiplierSpace<N>::product(const Vector& a) const {
  Vector out;
  if (hats) hats->multiply_mass<N>(a.loads, out.loads);
  for (std::size_t v = 0; v < a.bounds.size(); ++v) out.bounds.push_back(weights[v] * a.bounds[v]);
  for (std::size_t c = 0; c < a.moments.size(); ++c)
    out.moments.push_back(mass[c].cwiseProduct(a.moments[c]));
  return out;
}

template <int N>
double MultiplierSpace<N>::dot(const Vector& a, const Vector& b) const {
  double sum = fairing::dot<N>(a.loads, b.loads);
  for (std::size_t v = 0; v < a.bounds.size(); ++v) sum += a.bounds[v] * b.bounds[v];
  return sum + fairing::dot<2>(a.moments, b.moments);
}

template <int N>
void MultiplierSpace<N>::add(double factor, const Vector& a, const Vector& b, Vector& to) const {
  for (std::size_t v = 0; v < to.loads.size(); ++v)
    to.loads[v] += factor * (a.loads[v] + b.loads[v]);
  for (std::size_t v = 0; v < to.bounds.size(); ++v)
    to.bounds[v] += factor * (a.bounds[v] + b.bounds[v]);
  for (std::size_t c = 0; c < to.moments.size(); ++c)
    to.moments[c] += factor * (a.moments[c] + b.moments[c]);
}

template <int N>
void MultiplierSpace<N>::subtract(const Vector& a, Vector& from) const {
  for (std::size_t v = 0; v < from.loads.size(); ++v) from.loads[v] -= a.loads[v];
  for (std::size_t v = 0; v < from.bounds.size(); ++v) from.bounds[v] -= a.bounds[v];
  for (std::size_t c = 0; c < from.moments.size(); ++c) from.moments[c] -= a.moments[c];
}

template struct MultiplierSpace<1>;
template struct MultiplierSpace<3>;

}  // namespace fairing
