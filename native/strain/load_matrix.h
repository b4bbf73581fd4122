// SPDX-License-Identifier: GPL-3.0-or-later
// G, the loads on pads (constraints/pads.h) that moves of control vertices cause while all else
// stays, as a sparse matrix. The loads of the thin plate depend linearly on the control vertices,
// f = G c plus a constant, in the same way for x, y and z. The effect of a move falls by a factor of
// 2.6 with every ring of control faces, so distant vertices share a solve, a set for each coordinate.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "fairing/systems.h"
#include "strain/ease_system.h"

namespace fairing {

// Called before each solve with its part of the whole.
using OnPart = std::function<void(double begin, double end)>;

struct ProbedMatrix {
  LoadMatrix g;    // rows and columns of the given vertices
  int solves = 0;  // number of solves, each with three sets
};

// G of `vertices`, input vertices on pads, ascending, from sets with members at least `rings_apart`
// rings apart. In the result of a set each vertex is attributed to the nearest member. The part of
// a column beyond that goes to a nearer member, so rows keep their sums and a common move of all
// vertices has correct loads. Exact if every set has one member.
ProbedMatrix load_matrix(FairingSystems& systems, const std::vector<Index>& vertices,
                         int rings_apart, const OnPart& on_part);

// Number of rings around a vertex that show the shape itself. Of 1,681 vertices of an exact terrain
// the strains of 0 are wrong with two rings, 1 with three, 3 with four.
constexpr int rings_around = 2;

// Calls visit(i, around) for each of the `vertices`, where `around` has it, its copies, and all
// vertices at most `rings` rings away.
void visit_around(
    const ControlMesh& mesh, const std::vector<Index>& vertices, int rings,
    const std::function<void(std::size_t i, const std::vector<Index>& around)>& visit);

// The place of each vertex in `vertices`, of so many in all; -1: none.
std::vector<Index> numbered(std::size_t count, std::span<const Index> vertices);

// Approximate bytes of the matrix.
std::size_t bytes_of_load_matrix(std::size_t vertices, int rings_apart);

}  // namespace fairing
