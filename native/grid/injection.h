// SPDX-License-Identifier: GPL-3.0-or-later
// Injection: the values of a fine level at the points of the coarse level.
#pragma once

#include "grid/grid_level.h"
#include "parallel/workers.h"

namespace fairing {

// x_coarse <- x_fine at the points of both levels; `fine` is one level above `coarse`. C numbers a
// point.
template <int C, class T>
void inject(const GridLevel& coarse, const GridLevel& fine, Workers& workers, const T* x_fine,
            T* x_coarse);

}  // namespace fairing
