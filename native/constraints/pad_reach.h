// SPDX-License-Identifier: GPL-3.0-or-later
// The reach of the pad of a control vertex: a length, the same along all edges, and less where the
// mesh turns unevenly.
#pragma once

#include <array>
#include <vector>

#include "mesh/control_mesh.h"

namespace fairing {

// For both ends of each edge the share s of the edge over which the pad of that end reaches,
//
//   s_ca = min(1, reach_of_shortest r_c / |ca|) max((n_c . n_a)^2, 1 - |(n_c + n_a) . e|),
//
// with r_c the shortest control edge at c, n the mean normals of the faces around a vertex and e
// the edge's direction. For an end on a curve n is that of the edge's own faces, so that nothing
// depends on the other side of the curve.
//
// Why a length: hats over whole faces of any size hardly differ between two vertices a bevel apart;
// to separate these, their loads become huge and opposite, and the surface explodes. Why the
// normals: between a corner and a flat place wide pads bend the surface more than they smooth it.
std::vector<std::array<double, 2>> pad_reaches(const ControlMesh& mesh);

}  // namespace fairing
