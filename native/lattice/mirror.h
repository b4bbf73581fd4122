// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "control_mesh/mirror.h"
#include "execution/workers.h"
#include "lattice/accumulate.h"

namespace fairing {

// Where the points of a face lie in its image: closed coordinates go to closed coordinates by an affine map.
struct FaceImage {
  LatticePoint origin, i_step, j_step;

  LatticePoint of(int i, int j) const {
    return {origin.i + i * i_step.i + j * j_step.i, origin.j + i * i_step.j + j * j_step.j};
  }
};

// Of a face whose corner c goes to corner (turn - c) mod size.
FaceImage face_image(bool quad, int n, int turn);

// x <- the mean of x and its mirror image at the unknowns of a level, which are mirrored too; 3 numbers a point.
void mean_with_image(const Lattice& lattice, const Mirror& mirror, const Unknowns& unknowns, Workers& workers,
                     double* x);

// The same for displacements along normals, one number a point.
void mean_of_displacements(const Lattice& lattice, const Mirror& mirror, const Unknowns& unknowns,
                           Workers& workers, double* h);

}  // namespace fairing
