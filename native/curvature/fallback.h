// SPDX-License-Identifier: GPL-3.0-or-later
// Fallback for meshes so rough that plain steps on pads diverge: damped steps on point forces,
// which lower an energy.
#pragma once

#include "curvature/steps.h"

namespace fairing {

// Steps from `start` to least total curvature on point forces, with repair of folds on the finest
// level. Resets `report`. Throws ErrorCode::cancelled.
void run_fallback(SurfaceIterate& iterate, const StepStart& start, CurvatureLevelReport& report);

}  // namespace fairing
