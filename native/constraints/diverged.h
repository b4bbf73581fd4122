// SPDX-License-Identifier: GPL-3.0-or-later
// Where a surface has diverged from its control mesh: what pads are guarded by. Loads that have not
// settled, or that a solve in single precision could not bear, may move a part of it far away.
#pragma once

#include <span>
#include <vector>

#include "grid/grid_level.h"
#include "parallel/workers.h"

namespace fairing {

// The control vertices around which the surface x (3 numbers a point) has diverged: a point over the
// faces around one lies farther from them than these reach. `control`: where control vertices belong.
// Ascending. A position that is not finite is far away.
std::vector<Index> diverged_stars(const GridLevel& grid, Workers& workers,
                                  std::span<const Vec3> control, const double* x);

}  // namespace fairing
