// SPDX-License-Identifier: GPL-3.0-or-later
// Fallback for meshes so rough that plain steps on pads diverge: damped steps on point forces,
// which lower an energy, and then a change to the pads that the surface allows.
#pragma once

#include "curvature/unfold.h"

namespace fairing {

class RoughSteps {
 public:
  // All references must outlive it.
  RoughSteps(SurfaceIterate& iterate, Unfolding& unfolding, CurvatureSteps& steps)
      : it_(iterate), unfolding_(unfolding), steps_(steps) {}

  // Steps from `start` to least total curvature on point forces; on the finest level then on to
  // those of `pads`, if any, that the surface allows, and deactivates the others. Deactivates all
  // if folds had to be repaired (measured: of eleven such surfaces nine folded again on pads, had
  // more energy, or were not as near to a solution). Resets `report`. Throws ErrorCode::cancelled.
  void run(Pads* pads, const StepStart& start, CurvatureLevelReport& report);

 private:
  void run_on_points(const StepStart& start, CurvatureLevelReport& report);
  void go_onto(Pads& pads, const StepStart& start, CurvatureLevelReport& report);
  void leave_turned(Pads& pads);
  void leave_all(Pads& pads);
  void leave(Pads& pads, std::size_t v);
  // Plain steps to the end, undone if they make folds.
  void polish(CurvatureLevelReport& report);

  SurfaceIterate& it_;
  Unfolding& unfolding_;
  CurvatureSteps& steps_;
};

}  // namespace fairing
