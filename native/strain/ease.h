// SPDX-License-Identifier: GPL-3.0-or-later
// Moves control vertices so that the thin plate's surface through them is fair (ease_system.h).
// First those of feature curves, each curve by itself, then the others, with the curves as they are
// then.
#pragma once

#include <span>
#include <vector>

#include "fairing/options.h"
#include "parallel/monitor.h"
#include "strain/gauge.h"

namespace fairing {

struct EaseOptions {
  std::span<const double> tolerance{};  // the bound of each move, one an input vertex; or empty
  double amount = -1;                   // as of the result; below zero: by cross-validation
  // How many may move, the worst first, mirror images not counted; 0: as many as like.
  int most = 0;
  std::span<const std::uint8_t> fixed{};  // one an input vertex, over zero: stays; or empty
};

struct EaseResult {
  std::vector<Vec3> moves;  // per input vertex, in mesh units
  Excess before, after;     // strain
  double amount = 0;        // relative to the root mean square of the requested moves; no unit
  double noise = 0;         // root mean square of the removed scatter, mesh units
  int iterations = 0;       // solves in total
};

// Throws what measure_strain() throws; too_large if the matrix of loads is.
EaseResult ease_control_mesh(const PolygonMesh& input, const FairOptions& options,
                             const EaseOptions& wanted, Monitor& monitor);

}  // namespace fairing
