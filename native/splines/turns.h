// SPDX-License-Identifier: GPL-3.0-or-later
// How far a lattice is from being smooth.
#pragma once

#include "parallel/workers.h"
#include "splines/topology.h"

namespace fairing {

// By control faces, radians: the sharpest angle between the normals of two neighbouring cells, at
// least one of which is the face's. Creases and tips of kinks do not count, nor turns that are lower
// than `least`: at some control vertices the last cells turn at every level, ever smaller ones.
std::vector<double> lattice_turns(const Lattice& lattice, const Topology& topology, double least,
                                  Workers& workers);

}  // namespace fairing
