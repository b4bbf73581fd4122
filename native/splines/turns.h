// SPDX-License-Identifier: GPL-3.0-or-later
// How far a lattice is from being smooth.
#pragma once

#include "parallel/workers.h"
#include "splines/topology.h"

namespace fairing {

// By control faces, radians: the sharpest angle between the normals of two neighbouring cells, at
// least one of which is the face's; creases do not count.
std::vector<double> lattice_turns(const Lattice& lattice, const Topology& topology,
                                  Workers& workers);

}  // namespace fairing
