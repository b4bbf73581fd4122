// SPDX-License-Identifier: GPL-3.0-or-later
// The corrections of one held solve (held_solve.h).
#pragma once

namespace fairing {

struct HeldReport {
  int pad_corrections = 0;    // of the loads on pads, and of couples
  int constraint_rounds = 0;  // augmented-Lagrangian iterations: springs or targets
  double constraint_gap = 0;  // how far the energy may be above the minimum, relative
  double pad_force = 0;       // the last change of the loads, relative
  double normal_angle = 0;    // the largest between a fixed normal and the surface's, radians
};

}  // namespace fairing
