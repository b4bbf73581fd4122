// SPDX-License-Identifier: GPL-3.0-or-later
// Which points of a surface the solve may move.
#pragma once

#include "fairing/options.h"
#include "grid/accumulate.h"
#include "stencil/weights.h"

namespace fairing {

// Inside the region: control vertices that are free or weighted, and all points that are not on a
// feature curve. May throw FairingError(cancelled).
Unknowns choose_unknowns(const ControlMesh& mesh, const FairOptions& options);

// Throws FairingError(underdetermined), naming the vertices, when a component of the mesh has
// neither a fixed nor a weighted control vertex: any one point would be its fairest surface.
// `weights`: one a control vertex, or empty.
void require_anchored(const ControlMesh& mesh, const Unknowns& unknowns,
                      const VertexWeights& weights);

}  // namespace fairing
