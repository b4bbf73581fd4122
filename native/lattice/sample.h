// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "execution/workers.h"
#include "lattice/lattice.h"

namespace fairing {

// coarse <- fine at the points that both levels have; `fine` is one level above `coarse`, C numbers a point.
template <int C, class T>
void sample(const Lattice& coarse, const Lattice& fine, Workers& workers, const T* x_fine, T* x_coarse);

}  // namespace fairing
