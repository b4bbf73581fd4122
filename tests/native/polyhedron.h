// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "grid/linear.h"

namespace fairing::test {

// x <- the control polyhedron on a level, on this thread alone.
inline void refine_linearly(const GridLevel& grid, std::span<const Vec3> control, double* x) {
  Workers alone(1);
  fairing::refine_linearly(grid, control, alone, x);
}

}  // namespace fairing::test
