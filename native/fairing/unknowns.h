// SPDX-License-Identifier: GPL-3.0-or-later
// Which points of a surface the solve may move.
#pragma once

#include "fairing/options.h"
#include "grid/accumulate.h"
#include "stencil/weights.h"

namespace fairing {

// Inside the region: free and weighted control vertices, and all points off feature curves. May
// throw FairingError(cancelled).
Unknowns choose_unknowns(const ControlMesh& mesh, const FairOptions& options);

// Throws FairingError(underdetermined), naming the vertices, if a component has neither a fixed nor
// a weighted control vertex: any single point would be its fairest surface. `weights`: per control
// vertex, or empty.
void require_anchored(const ControlMesh& mesh, const Unknowns& unknowns,
                      const VertexWeights& weights);

}  // namespace fairing
