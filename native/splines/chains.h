// SPDX-License-Identifier: GPL-3.0-or-later
// From a layout to the curves along its lines and the patches between them.
#pragma once

#include "splines/layout.h"

namespace fairing {

// Fills in chains, places and patches. A line that comes back to where it began without an end gets
// one: a grid beside it becomes two.
void make_patches(const Lattice& lattice, const Walls& walls, std::vector<FaceGrid>& grids,
                  Topology& topology);

// Its two halves, across the longer sides.
std::array<FaceGrid, 2> halves_of(const FaceGrid& grid);

}  // namespace fairing
