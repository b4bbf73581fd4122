// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "control_mesh/control_mesh.h"

namespace fairing {

using SparseMatrix = Eigen::SparseMatrix<double>;

// A level's operator written out, for a direct solve.
struct AssembledSystem {
  SparseMatrix matrix;                // unknowns by unknowns, both triangles stored
  std::vector<Index> unknown_points;  // row -> point of the lattice
};

}  // namespace fairing
