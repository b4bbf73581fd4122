// SPDX-License-Identifier: GPL-3.0-or-later
// The control polyhedron as a surface: the start of iterations, and the outside of a region.
#pragma once

#include "grid/grid_level.h"
#include "parallel/workers.h"

namespace fairing {

// x <- the control polyhedron on a level: flat triangles, bilinear quads. 3 numbers a point.
void refine_linearly(const GridLevel& grid, std::span<const Vec3> control, Workers& workers,
                     double* x);

// The same for edges and faces outside the region and on its joint only; the rest of x stays. So do
// points on curves, and the faces beside them follow. `curve`: one an edge; negative: it has none.
void refine_outside(const GridLevel& grid, std::span<const Vec3> control,
                    std::span<const Index> curve, double* x);

}  // namespace fairing
