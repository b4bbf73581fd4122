// SPDX-License-Identifier: GPL-3.0-or-later
// Fallback for meshes so rough that plain steps on pads diverge: damped steps on point forces,
// which lower an energy, and then a change to the pads that the surface allows.
#pragma once

#include "curvature/fold_repair.h"

namespace fairing {

class FallbackSteps {
 public:
  // All references must outlive it.
  FallbackSteps(SurfaceIterate& iterate, FoldRepair& fold_repair, CurvatureSteps& steps)
      : it_(iterate), fold_repair_(fold_repair), steps_(steps) {}

  // Steps from `start` to least total curvature on point forces; on the finest level then on to
  // those of `pads`, if any, that the surface allows, and deactivates the others. Deactivates all
  // if folds had to be repaired (measured: of eleven such surfaces nine folded again on pads, had
  // more energy, or were not as near to a solution). Resets `report`. Throws ErrorCode::cancelled.
  void run(Pads* pads, const StepStart& start, CurvatureLevelReport& report);

 private:
  void run_on_points(const StepStart& start, CurvatureLevelReport& report);
  void move_to_pads(Pads& pads, const StepStart& start, CurvatureLevelReport& report);
  void deactivate_turned(Pads& pads);
  void deactivate_all(Pads& pads);
  void deactivate(Pads& pads, std::size_t v);
  // Plain steps to the end, undone if they make folds.
  void polish(CurvatureLevelReport& report);

  SurfaceIterate& it_;
  FoldRepair& fold_repair_;
  CurvatureSteps& steps_;
};

}  // namespace fairing
