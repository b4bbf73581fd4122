// SPDX-License-Identifier: GPL-3.0-or-later
// Which load on its pad a control vertex asks for when it alone moves: G's diagonal (probes.h).
#pragma once

#include <vector>

#include "thin_plate/solver.h"

namespace fairing {

// G_vv of each control vertex on the finest level; 0 where no pad is. (On the first level hats have so
// few points that it is half of that.) `curves`: the solver's, whose points do not move. Pads must be
// those of a surface that has been solved for. May throw what solves do.
std::vector<double> own_loads(ThinPlateSolver& solver, const FeatureCurves& curves);

}  // namespace fairing
