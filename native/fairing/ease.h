// SPDX-License-Identifier: GPL-3.0-or-later
// Control vertices put where the surface is fair (strain/ease.h), for the thin plate. First those of
// feature curves, each curve by itself, then the others about the curves as they are by then.
#pragma once

#include <span>
#include <vector>

#include "fairing/options.h"
#include "fairing/strain_gauge.h"
#include "parallel/monitor.h"

namespace fairing {

struct EaseOptions {
  std::span<const double> tolerance{};  // the bound of each move, one an input vertex; or empty
  double amount = -1;                   // as of the result; below zero: by cross-validation
  // How many may move, the worst first, mirror images not counted; 0: as many as like.
  int most = 0;
  std::span<const std::uint8_t> fixed{};  // one an input vertex, over zero: stays; or empty
};

struct EaseResult {
  std::vector<Vec3> moves;  // one an input vertex, in mesh units
  Excess before, after;     // strain
  double amount = 0;        // times the root mean square of what moves ask for: no unit
  double noise = 0;         // root mean square length of the scatter that was taken out, mesh units
  int iterations = 0;       // solves, all in all
};

// Throws what measure_strain() does; too_large where the matrix of loads is.
EaseResult ease_control_mesh(const PolygonMesh& input, const FairOptions& options,
                             const EaseOptions& wanted, Monitor& monitor);

}  // namespace fairing
