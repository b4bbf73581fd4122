// SPDX-License-Identifier: GPL-3.0-or-later
// G (probes.h) as a sparse matrix, by one solve for each set of distant vertices.
#pragma once

#include <span>
#include <vector>

#include "strain/ease_system.h"
#include "strain/probes.h"

namespace fairing {

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

// The place of each vertex in `vertices`, of so many in all; -1: none.
std::vector<Index> numbered(std::size_t count, std::span<const Index> vertices);

// Approximate bytes of the matrix.
std::size_t bytes_of_load_matrix(std::size_t vertices, int rings_apart);

}  // namespace fairing
