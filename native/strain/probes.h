// SPDX-License-Identifier: GPL-3.0-or-later
// The loads on pads (constraints/pads.h) that moves of control vertices cause while all else stays.
// The loads of the thin plate depend linearly on the control vertices, f = G c plus a constant, in
// the same way for x, y and z, so G is one matrix. The effect of a move falls by a factor of 2.6
// with every ring of control faces, so distant vertices share a solve, a set for each coordinate.
#pragma once

#include <functional>
#include <vector>

#include "fairing/systems.h"

namespace fairing {

// Sets of vertices on pads whose members are at least `rings_apart` rings apart; copies of a vertex
// count as one. Deterministic.
std::vector<std::vector<Index>> vertices_apart(const ControlMesh& mesh, const Pads& pads,
                                               int rings);

// For each control vertex the nearest member of a set by number of rings, the first of several; -1
// if none is reached. Copies of a vertex are as near as it is.
std::vector<Index> nearest_of(const ControlMesh& mesh, const std::vector<Index>& set);

// Calls visit(i, around) for each of the `vertices`, where `around` has it, its copies, and all
// vertices at most `rings` rings away.
void visit_around(
    const ControlMesh& mesh, const std::vector<Index>& vertices, int rings,
    const std::function<void(std::size_t i, const std::vector<Index>& around)>& visit);

// Calls on_loads(s, loads) for each set s in order. `loads`, one number a control vertex, are those
// after a move by one of all vertices of the set. `on_part`, if given, is called before each solve
// with its part of the whole.
using OnPart = std::function<void(double begin, double end)>;
using OnLoads = std::function<void(std::size_t set, const std::vector<double>& loads)>;
void probe_loads(FairingSystems& systems, const std::vector<std::vector<Index>>& sets,
                 const OnPart& on_part, const OnLoads& on_loads);

}  // namespace fairing
