// SPDX-License-Identifier: GPL-3.0-or-later
// Which holes have islands.
#pragma once

#include <span>
#include <vector>

#include "mesh/fill/fill.h"

namespace fairing {

// Holes of a loop each, checked, as holes with islands, in the order of their rims: a loop that lies inside another one
// and runs the other way round is the rim of an island in its hole, where the faces at both go on
// towards the ring between. Loops that share a vertex are holes of their own.
std::vector<Hole> with_islands(const PolygonMesh& mesh, const HalfEdges& half_edges,
                               std::span<const Hole> single);

}  // namespace fairing
