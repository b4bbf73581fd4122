// SPDX-License-Identifier: GPL-3.0-or-later
// Which mirror symmetries a run keeps: those of all that enters it. Steps would amplify what rounding makes of them.
#pragma once

#include "control_mesh/mirror.h"
#include "fair/placement.h"
#include "lattice/mirror.h"

namespace fairing {

using Mirrors = std::vector<const Mirror*>;

// Those of the control mesh, its curves and weights. The mesh is in working coordinates, as is all here.
std::vector<Mirror> find_symmetry(const ControlMesh& mesh, const Placement& place, const Frame& frame,
                                  const FairOptions& options);

// Those of them that other positions, a shape's, have too.
Mirrors kept_by(const Placement& place, const ControlMesh& mesh, const Frame& frame,
                const std::vector<Mirror>& mirrors);

}  // namespace fairing
