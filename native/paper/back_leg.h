// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "thin_plate/levels.h"

namespace fairing {

// The paper's own method [Kobbelt 1997a, §5], for comparison: topological refinement alternates
// with Gauss-Seidel smoothing, `sweeps` on each level, from the coarsest level up only. On one
// thread, and without a matrix.
void solve_back_leg(ThinPlateLevels& levels, const PlateData& data, int sweeps,
                    const Monitor& monitor, Array<double>& x, std::vector<LevelReport>& reports,
                    const std::function<void(const double*)>& on_prediction);

}  // namespace fairing
