// SPDX-License-Identifier: GPL-3.0-or-later
// Strain: which control vertices fight the surface. The load on a vertex' pad is that fight; over
// the load that a unit's move of this vertex alone would ask for (strain/load_matrix.h), it is the way
// by which the surface would spring, were that one vertex let go. For the thin plate.
#pragma once

#include "fairing/options.h"
#include "fairing/strain_gauge.h"
#include "fairing/systems.h"
#include "parallel/monitor.h"

namespace fairing {

struct Strain {
  Ways all;
  Excess excess;
  std::vector<std::uint8_t> on_curve;  // one an input vertex, over zero where a curve says it
};

// Loads are solved for on level `levels` of the options, at most on the second: they hardly change
// from there on. Throws FairingError: bad_option for other energies, for control vertices that are
// not to stay, and for point forces.
Strain measure_strain(const PolygonMesh& input, const FairOptions& options, Monitor& monitor);

// What the surface of these positions asks for on its pads.
struct PlateLoads {
  Loads free;    // as it is: no moment on curves
  Loads turned;  // with those of strain/border_moments.h
};
PlateLoads solve_loads(const FairingProblem& problem, FairingSystems& systems,
                       const ControlPositions& control, Stopwatch& watch);

// The options of the solve that strain is read off; throws what measure_strain() does.
FairOptions options_of_strain(const FairOptions& given);

}  // namespace fairing
