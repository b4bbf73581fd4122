// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "thin_plate/solver.h"

namespace fairing {

// The epsilon post-process of [Kobbelt 1997a, §5]: interpolated control vertices step to where the
// energy wants them, at most epsilon (working units) away, and the surface follows; this takes the
// cusps off. `data` and `state` are those of x, `tolerance` that of the solves. Returns how many.
int release_control_vertices(ThinPlateSolver& solver, const PlateData& data, double epsilon,
                             double tolerance, PlateState& state, Array<double>& x);

}  // namespace fairing
