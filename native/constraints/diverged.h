// SPDX-License-Identifier: GPL-3.0-or-later
// Finds where a surface has diverged from its control mesh, which guards pads: loads that have not
// settled, or that single precision cannot represent, may move a part of it far away.
#pragma once

#include <span>
#include <vector>

#include "grid/grid_level.h"
#include "parallel/workers.h"

namespace fairing {

// In sizes of a part of the mesh: a point farther from its centre is at least a size away.
constexpr double far_away = 2;

// The control vertices around which the surface x (3 numbers a point) has diverged: a point over
// the faces around the vertex is farther from them than their size. `control`: the targets of the
// control vertices. Ascending. A position that is not finite is far away.
std::vector<Index> diverged_stars(const GridLevel& grid, Workers& workers,
                                  std::span<const Vec3> control, const double* x);

}  // namespace fairing
