// SPDX-License-Identifier: GPL-3.0-or-later
// Which loads on pads (constraints/pads.h) moves of control vertices ask for, where all else stays. Loads
// follow the control vertices of the thin plate linearly, f = G c and what fixed data add, and the
// plate knows no direction, so G is one matrix for x, y and z. What moving one vertex does falls by
// some 2.6 with every ring of control faces: vertices far apart share a solve, one set of them for
// each coordinate.
#pragma once

#include <functional>
#include <vector>

#include "thin_plate/solver.h"

namespace fairing {

// Sets of vertices on pads, those of a set at least so many rings apart; copies of a vertex count as
// one. Deterministic.
std::vector<std::vector<Index>> vertices_apart(const ControlMesh& mesh, const Pads& pads,
                                               int rings);

// For each control vertex the member of a set that is fewest rings away, of several the first; -1
// where none is reached. A vertex' copies are as near as it is.
std::vector<Index> nearest_of(const ControlMesh& mesh, const std::vector<Index>& set);

// visit(i, around) for each of the `vertices`: it, its copies, and all at most so many rings away.
void visit_around(
    const ControlMesh& mesh, const std::vector<Index>& vertices, int rings,
    const std::function<void(std::size_t i, const std::vector<Index>& around)>& visit);

// Calls on_loads(s, loads) for each set, in turn: `loads`, one number a control vertex, are asked for
// where all vertices of set s have moved by one. `curves`: the solver's, whose points do not move.
// `on_part`, where given, is told before each solve which part of all of them it is.
using OnPart = std::function<void(double begin, double end)>;
using OnLoads = std::function<void(std::size_t set, const std::vector<double>& loads)>;
void probe_loads(ThinPlateSolver& solver, const FeatureCurves& curves,
                 const std::vector<std::vector<Index>>& sets, const OnPart& on_part,
                 const OnLoads& on_loads);

}  // namespace fairing
