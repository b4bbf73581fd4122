// SPDX-License-Identifier: GPL-3.0-or-later
// Finds islands in holes.
#pragma once

#include <span>
#include <vector>

#include "mesh/fill/fill.h"

namespace fairing {

// Checked holes of one loop each, combined to holes with islands, in the order of their rims: a
// loop inside another one with the opposite direction is the rim of an island, if the faces at both
// continue towards the ring between. Loops that share a vertex are separate holes.
std::vector<Hole> with_islands(const PolygonMesh& mesh, const HalfEdges& half_edges,
                               std::span<const Hole> single);

}  // namespace fairing
