// SPDX-License-Identifier: GPL-3.0-or-later
// Details of a scan that are finer than the control mesh can carry.
#pragma once

#include "fit/level_fit.h"

namespace fairing {

// A surface bends about no radius below a tenth of a control edge: a patch of one face cannot
// follow that, and where points ask for less the surface folds. Points over such faces act less,
// pass by pass; where they hardly act any more, the points around make the fold, and act less too.
void round_off(LevelFit& fit, double weight);

}  // namespace fairing
