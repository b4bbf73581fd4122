// SPDX-License-Identifier: GPL-3.0-or-later
// What a solve of the thin plate leaves for the next one, beside the surface.
#pragma once

#include "constraints/multipliers.h"
#include "multigrid/pcg.h"

namespace fairing {

struct PlateState : Multipliers<3> {
  PcgLimits limits{};  // of the finest level, as when the surface was solved from nothing
};

}  // namespace fairing
