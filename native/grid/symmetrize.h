// SPDX-License-Identifier: GPL-3.0-or-later
// Makes vectors on a level symmetric under the mirrors of its control mesh. Rounding differs between
// the two sides of a mirror, and steps over crumpled places amplify the difference until damping
// decides differently, so Gauss-Newton steps need this each time.
#pragma once

#include "grid/accumulate.h"
#include "mesh/symmetry.h"
#include "parallel/workers.h"

namespace fairing {

// The affine map from the closed coordinates of a face to those of its image.
struct FaceImage {
  GridPoint origin, i_step, j_step;

  GridPoint of(int i, int j) const {
    return {origin.i + i * i_step.i + j * j_step.i, origin.j + i * i_step.j + j * j_step.j};
  }
};

// For a face whose corner c is mapped to corner (turn - c) mod size, or to itself (Mirror::turn).
FaceImage face_image(bool quad, int n, int turn);

// x <- the mean of x and its mirror images at the unknowns of a level, which must be symmetric too;
// 3 numbers a point.
void symmetrize(const GridLevel& grid, const Symmetry& symmetry, const Unknowns& unknowns,
                Workers& workers, double* x);

// The same for displacements along normals, one number a point; nothing within the plane.
void symmetrize_displacements(const GridLevel& grid, const Symmetry& symmetry,
                              const Unknowns& unknowns, Workers& workers, double* h);

}  // namespace fairing
