// SPDX-License-Identifier: GPL-3.0-or-later
// Gauss-Newton steps as vectors that can be accelerated (hold/anderson.h).
#pragma once

#include "curvature/system.h"
#include "hold/anderson.h"
#include "parallel/reductions.h"

namespace fairing {

// Decrement below which steps are accelerated: each then leaves a fixed share of the error.
constexpr double accelerated_decrement = 0.1;
constexpr std::size_t accelerated_steps = 3;  // that are remembered

// A step, and what it changes of the loads on pads.
struct HeldStep {
  Array<double> along;  // the normals, 1 number a point
  NormalLoads loads;    // empty: there are none
};

// Steps in the norm of the operator, as it is linearized where the latest one begins. Loads follow
// from the surface: they go along, and are not judged by.
struct StepSpace {
  using Vector = HeldStep;

  SurfaceIterate* iterate;

  Vector product(const Vector& a) const {
    Vector out{Array<double>(a.along.size()), {}};
    iterate->op().apply(a.along.data(), out.along.data());
    return out;
  }
  double dot(const Vector& a, const Vector& b) const {
    return sum(iterate->workers(), a.along.size(),
               [&](std::size_t i) { return a.along[i] * b.along[i]; });
  }
  void add(double factor, const Vector& a, const Vector& b, Vector& to) const {
    for_each_index(iterate->workers(), to.along.size(),
                   [&](std::size_t i) { to.along[i] += factor * (a.along[i] + b.along[i]); });
    for (std::size_t v = 0; v < to.loads.size(); ++v)
      to.loads[v] += factor * (a.loads[v] + b.loads[v]);
  }
  void subtract(const Vector& a, Vector& from) const {
    for_each_index(iterate->workers(), from.along.size(),
                   [&](std::size_t i) { from.along[i] -= a.along[i]; });
    for (std::size_t v = 0; v < from.loads.size(); ++v) from.loads[v] -= a.loads[v];
  }
  void scale(double factor, Vector& a) const {
    for (double& entry : a.along) entry *= factor;
    for (auto& load : a.loads) load *= factor;
  }
};

}  // namespace fairing
