// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "execution/workers.h"
#include "solver/level_operator.h"

namespace fairing {

// The largest eigenvalue of D^-1 K, by a few Lanczos steps from D^-1 `start` (a safe margin included). A start that
// moves with the mesh, such as a residual, makes the estimate independent of numbering and position.
double largest_eigenvalue(LevelOperator& op, Workers& workers, const float* start);

}  // namespace fairing
