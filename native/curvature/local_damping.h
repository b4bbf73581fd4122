// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "curvature/level.h"

namespace fairing {

// Also marks (above zero) the neighbours of marked points; removes marks from points that are not
// unknowns, unless `unknowns` is null.
void dilate(const GridLevel& grid, Workers& workers, ElementSlots<float, 1>& slots,
            const Unknowns* unknowns, Array<float>& marks);

// Damping of Gauss-Newton steps for each point: mu_i K_ii is added to the diagonal. Where the
// second fundamental form after a step differs from the predicted M + J h, the surface is crumpled.
// Undamped steps make folds there, and uniform damping would stop the whole surface for a few such
// places. So mu_i grows where the prediction failed, with its ring, and falls elsewhere.
class LocalDamping {
 public:
  LocalDamping(const GridLevel& grid, const Unknowns& unknowns, Workers& workers);

  // Empty if there is no damping.
  const Array<float>& mu() const { return any_ ? mu_ : none_; }

  // Call it after a full step. `predicted`: M + J h (3 numbers a point, in the charts of `before`).
  // `before` and `after` must have axes. `rejections` and `steps`: numbers of rejected and accepted
  // steps so far. Returns whether mu changed.
  bool judge(const Array<float>& predicted, const Linearization& before, const Linearization& after,
             int rejections, int steps, double decrement);

  // Keeps mu of marked points (above zero) at the initial factor at least.
  void hold(const Array<float>& marks);

 private:
  void start();

  const GridLevel& grid_;
  const Unknowns& unknowns_;
  Workers& workers_;
  ElementSlots<float, 1> slots_;
  bool any_ = false;
  Array<float> mu_, least_, none_;
  std::vector<std::uint8_t> failures_;
};

}  // namespace fairing
