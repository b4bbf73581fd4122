// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "energy/curvature_level.h"

namespace fairing {

// Where a Gauss-Newton step finds another curvature than it foresaw, the surface is crumpled: going on there undamped
// makes folds, and damping everywhere would stop the rest. So every point has a factor mu of its own, times the
// operator's diagonal, that grows where the prediction failed and fades where it held.
class LocalDamping {
 public:
  LocalDamping(const Lattice& lattice, const Unknowns& unknowns, Workers& workers);

  // Empty while there is none.
  const Array<float>& mu() const { return any_ ? mu_ : none_; }

  // After a full step: what M was foreseen to be (3 numbers a point, in the charts of before), what it was and what it is.
  // `rejections` of steps before, `steps` accepted so far, the relative decrement. Returns whether mu changed.
  bool judge(const Array<float>& predicted, const CurvatureLevel::Surface& before,
             const CurvatureLevel::Surface& after, int rejections, int steps, double decrement);

  // Marked points (above zero) have at least that factor from here on.
  void hold(const Array<float>& marks, float least);

 private:
  void start();

  const Lattice& lattice_;
  const Unknowns& unknowns_;
  Workers& workers_;
  Exchange<float, 1> exchange_;
  bool any_ = false;
  Array<float> mu_, least_, none_;
  std::vector<std::uint8_t> failures_;
};

}  // namespace fairing
