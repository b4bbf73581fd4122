// SPDX-License-Identifier: GPL-3.0-or-later
// Strain shows which control vertices spoil the surface. It is the load on a vertex' pad over the
// load of a unit move of that vertex alone (strain/load_matrix.h): the distance by which the
// surface would move if that vertex were released. For the thin plate.
#pragma once

#include "parallel/monitor.h"
#include "strain/gauge.h"

namespace fairing {

struct Strain {
  Ways all;
  Excess excess;
  std::vector<std::uint8_t> on_curve;  // per input vertex; nonzero if its strain is that of a curve
};

// Loads are solved for on level `levels` of the options, at most on level 2, since they hardly
// change on finer ones. Throws FairingError: bad_option for other energies, for control vertices
// that may move, and for point forces.
Strain measure_strain(const PolygonMesh& input, const FairOptions& options, Monitor& monitor);

// The loads on pads of the surface through these positions.
struct PlateLoads {
  Loads free;    // without moments on curves
  Loads turned;  // with the moments of strain/border_moments.h
};
PlateLoads solve_loads(const FairingProblem& problem, FairingSystems& systems,
                       const ControlPositions& control, Stopwatch& watch);

// The options of the solve that measures strain; throws what measure_strain() throws.
FairOptions options_of_strain(const FairOptions& given);

}  // namespace fairing
