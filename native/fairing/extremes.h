// SPDX-License-Identifier: GPL-3.0-or-later
// Positions too far apart to compute with. No run returns a number that is not finite, and no
// surface without enough digits starts another.
#pragma once

#include <cstddef>

#include "fairing/control_positions.h"
#include "parallel/workers.h"

namespace fairing {

// Whether control vertices are so far from where charts were made that the surface and the solvers'
// state have too few digits for a next surface to start from.
bool lies_far_out(const ControlMesh& mesh, const ControlPositions& control);

// Throws FairingError(too_extreme), naming input vertices that are so far from where charts were
// made that rounding there is as large as the mesh.
void require_in_reach(const ControlMesh& mesh, const ControlPositions& control);

// Throws FairingError(too_extreme) if one of these numbers of a surface is not finite. Names the
// input vertices that are far from all others, if any.
void require_finite(const ControlMesh& mesh, const ControlPositions& control, Workers& workers,
                    std::size_t size, const double* x);

}  // namespace fairing
