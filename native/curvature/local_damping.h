// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "curvature/level.h"

namespace fairing {

// Marks (above zero) the neighbours of marked points as well; those that are no unknowns lose
// theirs, unless `unknowns` is null.
void dilate(const GridLevel& grid, Workers& workers, ElementSlots<float, 1>& slots,
            const Unknowns* unknowns, Array<float>& marks);

// Damping of Gauss-Newton steps, point by point: mu_i K_ii is added to the operator's diagonal.
// Where a step finds another second fundamental form than M + J h, which it predicted, the surface
// is crumpled: steps that go on undamped there make folds, and a uniform damping would stop the
// whole surface for a few such places. So each mu_i grows where the prediction failed, with the
// ring around, and falls where it held.
class LocalDamping {
 public:
  LocalDamping(const GridLevel& grid, const Unknowns& unknowns, Workers& workers);

  // Empty while there is none.
  const Array<float>& mu() const { return any_ ? mu_ : none_; }

  // After a full step: `predicted`, M + J h (3 numbers a point, in the charts of `before`), against
  // what was found before the step and after it; both with axes. `rejections` and `steps`: how many
  // have been rejected and accepted before; `decrement`: of this step. Returns whether mu changed.
  bool judge(const Array<float>& predicted, const Linearization& before, const Linearization& after,
             int rejections, int steps, double decrement);

  // Marked points (above zero) keep the least factor from here on.
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
