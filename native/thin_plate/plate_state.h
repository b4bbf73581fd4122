// SPDX-License-Identifier: GPL-3.0-or-later
// What a solve of the thin plate leaves for the next one, beside the surface.
#pragma once

#include "hold/couples.h"
#include "hold/pads.h"
#include "multigrid/pcg.h"

namespace fairing {

struct PlateState {
  Loads loads{};       // on the pads; empty without
  Moments moments{};   // of the couples that fix normals; empty without
  PcgLimits limits{};  // of the finest level, as when the surface was solved from nothing
};

}  // namespace fairing
