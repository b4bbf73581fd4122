// SPDX-License-Identifier: GPL-3.0-or-later
// Derives from a layout the curves along its lines and the patches between them.
#pragma once

#include "splines/layout.h"

namespace fairing {

// Sets chains, places and patches. A closed line without an end gets one: a grid next to it is cut
// in two.
void make_patches(const Lattice& lattice, const Walls& walls, std::vector<FaceGrid>& grids,
                  Topology& topology);

// The two halves of a grid, cut across its longer sides.
std::array<FaceGrid, 2> halves_of(const FaceGrid& grid);

}  // namespace fairing
