// SPDX-License-Identifier: GPL-3.0-or-later
// The mirror symmetries that a surface keeps: those of everything it depends on. Gauss-Newton steps
// average with the mirror image, because they amplify rounding.
#pragma once

#include "fairing/control_positions.h"
#include "fairing/options.h"
#include "mesh/mirror.h"

namespace fairing {

// The mirrors of the control mesh, its curves and weights, up to three. `mesh` is in working
// coordinates, and so are the mirrors. May throw FairingError(cancelled).
std::vector<Mirror> find_symmetry(const ControlMesh& mesh, const ControlPositions& control,
                                  const Frame& frame, const FairOptions& options);

// Those of `mirrors` that other positions have too. Points to elements of `mirrors`.
Mirrors kept_by(const ControlPositions& control, const ControlMesh& mesh, const Frame& frame,
                const std::vector<Mirror>& mirrors);

}  // namespace fairing
