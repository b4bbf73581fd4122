// SPDX-License-Identifier: GPL-3.0-or-later
// What a solve of the thin plate keeps for the next one, besides the surface.
#pragma once

#include "constraints/multipliers.h"
#include "multigrid/pcg.h"

namespace fairing {

struct PlateState : Multipliers<3> {
  PcgLimits limits{};  // of the finest level, from the first solve
};

}  // namespace fairing
