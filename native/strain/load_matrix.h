// SPDX-License-Identifier: GPL-3.0-or-later
// G (probes.h) as a sparse matrix: as many solves as sets of vertices far apart, not as vertices.
#pragma once

#include <vector>

#include "strain/ease.h"
#include "strain/probes.h"

namespace fairing {

struct ProbedMatrix {
  LoadMatrix g;    // rows and columns of the vertices asked for
  int solves = 0;  // of three sets each
};

// G of `vertices`, input vertices on pads, ascending, by sets that are so many rings apart. Of each
// set's answer a vertex takes its share
// as if it came from the set's nearest vertex alone: what is cut off of a column far away goes to a
// nearer one, so that rows keep their sums and moves of all alike ask for what they should. Exact
// where no two vertices share a set.
ProbedMatrix load_matrix(ThinPlateSolver& solver, const FeatureCurves& curves,
                         const std::vector<Index>& vertices, int rings_apart,
                         const OnPart& on_part);

// Bytes of the matrix of so many vertices, about.
std::size_t bytes_of_load_matrix(std::size_t vertices, int rings_apart);

}  // namespace fairing
