// SPDX-License-Identifier: GPL-3.0-or-later
// What one held solve (held_solve.h) did to control vertices.
#pragma once

namespace fairing {

struct HeldReport {
  int pad_corrections = 0;    // of the loads on pads, and of couples
  int constraint_rounds = 0;  // with springs set, or targets shifted, for tolerances
  double constraint_gap = 0;  // how far the energy may be above the least one, relative
  double pad_force = 0;  // what the last correction changed of the loads, or would have; relative
  double normal_angle = 0;  // the largest between a fixed normal and the surface's; radians
};

}  // namespace fairing
