// SPDX-License-Identifier: GPL-3.0-or-later
// How far the pad under a control vertex reaches: a length, the same along all edges, and less where
// the mesh turns unevenly.
#pragma once

#include <array>
#include <vector>

#include "mesh/control_mesh.h"

namespace fairing {

// Of both ends of each edge: the share s of the edge that the pad under that end reaches over,
//
//   s_ca = min(1, reach_of_shortest r_c / |ca|) max((n_c . n_a)^2, 1 - |(n_c + n_a) . e|),
//
// with r_c the shortest control edge at c, n the mean normals of the faces around a vertex and e the
// edge's direction. Of an end on a curve n is that of the edge's own faces, so that nothing differs
// across the curve.
//
// Why a length: hats that reach across each face, whatever its size, hardly differ between two
// vertices a bevel apart; to tell these apart, their loads become huge and opposite, and the surface
// is blown up. Why the normals: between a corner and a flat place, wide pads bend the surface more
// than they make it even.
std::vector<std::array<double, 2>> pad_reaches(const ControlMesh& mesh);

}  // namespace fairing
