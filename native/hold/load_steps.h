// SPDX-License-Identifier: GPL-3.0-or-later
// How the loads on pads are found. B f = r says which loads take the point forces r off the control
// vertices, with B = H^T Omega Phi and H the cardinal surfaces of K (1 at one control vertex, 0 at
// the others); it is close to the hats' mass matrix M (measured: eigenvalues of M^-1 B from 0.2 to
// 1.3). So a surface is solved for with the loads as they are, the forces that are left are read,
// loads take the correction M^-1 r, and Anderson's acceleration [Walker and Ni 2011] makes of these
// corrections what GMRES would.
#pragma once

#include <deque>
#include <vector>

#include "hold/pads.h"

namespace fairing {

template <int N>
double dot(const LoadsOf<N>& a, const LoadsOf<N>& b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) sum += a[v].dot(b[v]);
  return sum;
}

// What holds control vertices: the loads on their pads, and multipliers of what bounds them, one an
// input vertex. Either may be empty.
template <int N>
struct Multipliers {
  LoadsOf<N> loads;
  std::vector<double> bounds;
};

// Anderson's acceleration of f <- f + M^-1 r, in the norm of M, and of multipliers along with it.
template <int N>
class LoadSteps {
 public:
  // `pads` must outlive it and keep its level.
  explicit LoadSteps(const Pads& pads) : pads_(&pads) {}
  // The same; null where there are no loads. Changes of multipliers are compared by `weights`, which
  // make them comparable with changes of loads.
  LoadSteps(const Pads* pads, std::vector<double> weights)
      : pads_(pads), weight_(std::move(weights)) {}

  // The change to make, from this correction, M^-1 r, and the last few.
  LoadsOf<N> change(const LoadsOf<N>& correction) {
    return change(Multipliers<N>{correction, {}}).loads;
  }
  Multipliers<N> change(const Multipliers<N>& correction);
  // What has been made of the last change, where that is something else.
  void took(Multipliers<N> change) { last_change_ = std::move(change); }
  // The next correction is the first one.
  void forget();

 private:
  struct Pair {
    Multipliers<N> bent, gone, product;  // of the correction, of f; M times the former
  };
  Multipliers<N> product(const Multipliers<N>& a) const;

  const Pads* pads_;
  std::vector<double> weight_;
  std::deque<Pair> pairs_;
  bool any_ = false;
  Multipliers<N> last_, last_change_;
};

}  // namespace fairing
