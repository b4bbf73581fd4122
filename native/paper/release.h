// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "thin_plate/solver.h"

namespace fairing {

// The epsilon post-process of [Kobbelt 1997a, §5]: interpolated control vertices move to the
// position of least energy, at most epsilon (working units) away, and the surface is solved again;
// this removes cusps. `data` and `state` are those of x, `tolerance` that of the solves. Returns
// the number of solves.
int release_control_vertices(ThinPlateSolver& solver, const PlateData& data, double epsilon,
                             double tolerance, PlateState& state, Array<double>& x);

}  // namespace fairing
