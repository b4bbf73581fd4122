// SPDX-License-Identifier: GPL-3.0-or-later
// Details of a scan for which the surface would fold.
#pragma once

#include "fit/level_fit.h"

namespace fairing {

// Where points ask for more, a surface turns by over a right angle from cell to cell and folds. Points
// over such faces act less, pass by pass; where they hardly act any more, the points around make the
// fold, and act less too.
void round_off(LevelFit& fit, double weight);

}  // namespace fairing
