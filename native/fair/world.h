// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces on their way out, to the caller's coordinates.
#pragma once

#include "execution/workers.h"
#include "fair/placement.h"
#include "lattice/lattice.h"

namespace fairing {

// world <- the surface x of working coordinates, on the finest level; they may be the same array. Whatever has not moved
// comes back to the last bit.
void to_world(const Placement& place, const Lattice& lattice, const Frame& frame, Workers& workers,
              const double* x, double* world);

// Of an input vertex from its place.
double largest_deviation(const std::vector<Vec3>& given, Index input_vertices, const double* world);

}  // namespace fairing
