// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric, diagonally dominant tridiagonal systems, open or cyclic, for three coordinates.
#pragma once

#include <vector>

#include "base/types.h"

namespace fairing {

// Returns the x of
//
//   right[i - 1] x[i - 1] + diagonal[i] x[i] + right[i] x[i + 1] = value[i].
//
// With `cyclic` (at least three unknowns), right.back() couples the last unknown to the first;
// without, it is not used. Dominance makes pivoting needless. Linear time.
std::vector<Vec3> solve_tridiagonal(const std::vector<double>& diagonal,
                                    const std::vector<double>& right, std::vector<Vec3> value,
                                    bool cyclic);

}  // namespace fairing
