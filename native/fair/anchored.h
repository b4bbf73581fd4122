// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "energy/thin_plate.h"

namespace fairing {

// Throws FairingError(underdetermined), naming the vertices, when a component of the mesh has neither a fixed nor a
// weighted control vertex: any one point would be its fairest surface.
void require_anchored(const ControlMesh& mesh, const Unknowns& unknowns, const VertexWeights& weights);

}  // namespace fairing
