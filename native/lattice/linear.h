// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "execution/workers.h"
#include "lattice/lattice.h"

namespace fairing {

// The control polyhedron on a level: flat triangles, bilinear quads. 3 numbers a point.
void refine_linearly(const Lattice& lattice, std::span<const Vec3> control, Workers& workers, double* x);
// The same on the calling thread alone.
void refine_linearly(const Lattice& lattice, std::span<const Vec3> control, double* x);

// The same for edges and faces outside the region and on its joint alone; the rest of x stays.
void refine_outside_linearly(const Lattice& lattice, std::span<const Vec3> control, double* x);

}  // namespace fairing
