// SPDX-License-Identifier: GPL-3.0-or-later
// Fallback for meshes so rough that plain steps on pads diverge: damped steps on point forces,
// which lower an energy, and then a change to the pads that the surface allows.
#pragma once

#include "curvature/steps.h"

namespace fairing {

// Steps from `start` to least total curvature on point forces; on the finest level then on to those
// of `pads`, if any, that the surface allows, and deactivates the others. Deactivates all if folds
// had to be repaired (measured: of eleven such surfaces nine folded again on pads, had more energy,
// or were not as near to a solution). Resets `report`. Throws ErrorCode::cancelled.
void run_fallback(SurfaceIterate& iterate, Pads* pads, const StepStart& start,
                  CurvatureLevelReport& report);

}  // namespace fairing
