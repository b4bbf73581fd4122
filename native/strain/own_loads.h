// SPDX-License-Identifier: GPL-3.0-or-later
// Which load on its pad (hold/pads.h) a control vertex of the thin plate asks for when it alone
// moves. Loads follow the control vertices linearly, f = G c and what fixed data add, and the plate
// knows no direction, so G is one matrix for x, y and z. Its diagonal is probed: what moving one
// vertex does falls by some 2.6 with every ring of control faces, so vertices far apart share a
// solve, one set of them for each coordinate.
#pragma once

#include <vector>

#include "thin_plate/solver.h"

namespace fairing {

// G_vv of each control vertex on the finest level; 0 where no pad is. (On the first level hats have so
// few points that it is half of that.) `curves`: the solver's, whose points do not move. Pads must be
// those of a surface that has been solved for. May throw what solves do.
std::vector<double> own_loads(ThinPlateSolver& solver, const FeatureCurves& curves);

// Sets of vertices on pads, those of a set at least so many rings apart; copies of a vertex count as
// one. Deterministic.
std::vector<std::vector<Index>> vertices_apart(const ControlMesh& mesh, const Pads& pads,
                                               int rings);

}  // namespace fairing
