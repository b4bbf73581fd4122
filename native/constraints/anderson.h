// SPDX-License-Identifier: GPL-3.0-or-later
// Anderson's acceleration of steps that each leave a fixed share of the error [Anderson 1965;
// Walker and Ni 2011]: the last few steps reveal that share. With the changes dF_k of the steps and
// dx_k of the iterate, a step f becomes
//
//   f - sum_k c_k (dF_k + dx_k),
//
// where c minimizes the norm of f - sum_k c_k dF_k. On linear problems it is GMRES.
#pragma once

#include <deque>
#include <functional>

#include "parallel/memory.h"

namespace fairing {

class Anderson {
 public:
  using Vector = Array<double>;

  // Remembers `depth` steps; each costs a product and two vectors. `product`: the norm's matrix times
  // a vector; numbers after the last one of the product are not in the norm. `dot`: of so many
  // numbers of two vectors.
  Anderson(std::size_t depth, std::function<Vector(const Vector&)> product,
           std::function<double(std::size_t, const Vector&, const Vector&)> dot)
      : depth_(depth), product_(std::move(product)), dot_(std::move(dot)) {}

  // The change of the iterate, from this step and the last few.
  Vector change(const Vector& step);
  // Call it if this share of the last change() was made.
  void took_share(double share) {
    for (double& number : last_change_) number *= share;
  }
  // Makes the next step the first one.
  void forget() {
    pairs_.clear();
    any_ = false;
  }

 private:
  struct Pair {
    Vector step_change, iterate_change;  // dF and dx
  };
  std::size_t depth_;
  std::function<Vector(const Vector&)> product_;
  std::function<double(std::size_t, const Vector&, const Vector&)> dot_;
  std::deque<Pair> pairs_;
  bool any_ = false;
  Vector last_, last_change_;
};

}  // namespace fairing
