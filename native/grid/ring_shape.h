// SPDX-License-Identifier: GPL-3.0-or-later
// The one-rings of a run's points as cycles of neighbours.
#pragma once

#include "grid/runs.h"

namespace fairing {

// Whether a grid step leads across a quad.
constexpr bool is_far(bool quad, GridPoint step) { return quad && step.i * step.j != 0; }

// The common shape of the rings of a run.
struct RingShape {
  std::vector<std::uint8_t> far;  // of the neighbours: whether they are across a quad
  int first = 0;                  // start of the ring; on the boundary for an open one
  bool closed = true;

  void set(const GridLevel& grid, const Run& run);
};

}  // namespace fairing
