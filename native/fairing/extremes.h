// SPDX-License-Identifier: GPL-3.0-or-later
// Positions too far apart to compute with: nothing that is not finite leaves a run, and no surface
// that has lost its digits starts another.
#pragma once

#include <cstddef>

#include "fairing/control_positions.h"
#include "parallel/workers.h"

namespace fairing {

// Whether control vertices lie so far from where charts were made that the surface, and what the
// solvers have learnt from it, has too few digits for another one to start from.
bool lies_far_out(const ControlMesh& mesh, const ControlPositions& control);

// Throws FairingError(too_extreme), naming the input vertices, where some lie so far from where
// charts were made that rounding there is as large as the mesh.
void require_in_reach(const ControlMesh& mesh, const ControlPositions& control);

// Throws FairingError(too_extreme) where one of so many numbers of a surface is not finite. Names
// the input vertices that lie far from all others, if there are such.
void require_finite(const ControlMesh& mesh, const ControlPositions& control, Workers& workers,
                    std::size_t size, const double* x);

}  // namespace fairing
