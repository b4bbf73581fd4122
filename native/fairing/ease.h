// SPDX-License-Identifier: GPL-3.0-or-later
// Control vertices put where the surface is fair (strain/ease.h), for the thin plate.
#pragma once

#include <span>
#include <vector>

#include "fairing/options.h"
#include "parallel/monitor.h"

namespace fairing {

struct EaseOptions {
  std::span<const double> tolerance{};    // the bound of each move, one an input vertex; or empty
  int most = 0;                           // how many may move, the worst first; 0: as many as like
  std::span<const std::uint8_t> fixed{};  // one an input vertex, over zero: stays; or empty
};

struct EaseResult {
  // One an input vertex, in mesh units. Strain along the control mesh's normal before; NaN where no
  // pad is: such vertices stay.
  std::vector<Vec3> moves;
  std::vector<double> strain_before, strain_after;
  double amount = 0, noise = 0;  // strain/ease.h; the noise in mesh units
  int iterations = 0;            // solves, without those for strain
};

// Throws what measure_strain() does, and bad_option for a mesh that had to be mended.
EaseResult ease_control_mesh(const PolygonMesh& input, const FairOptions& options,
                             const EaseOptions& wanted, Monitor& monitor);

}  // namespace fairing
