// SPDX-License-Identifier: GPL-3.0-or-later
// Measures the smoothness of a lattice.
#pragma once

#include "parallel/workers.h"
#include "splines/topology.h"

namespace fairing {

// For each control face, in radians: the largest angle between the normals of two adjacent cells,
// at least one of them in the face. Creases and tips of kinks do not count, nor do turns whose
// height is less than `least`: at some control vertices the last cells turn at every level, but are
// smaller and smaller.
std::vector<double> lattice_turns(const Lattice& lattice, const Topology& topology, double least,
                                  Workers& workers);

}  // namespace fairing
