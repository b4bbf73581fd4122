// SPDX-License-Identifier: GPL-3.0-or-later
// The thin plate's K on one level as a sparse matrix in single precision, for levels whose faces have few points: there
// passes over faces and edges cost more than an index a number. For the smoother, which wants many cheap applications.
#pragma once

#include "energy/plate_rings.h"
#include "rows/matrix.h"
#include "solver/level_operator.h"

namespace fairing {

class PlateMatrix {
 public:
  // Whether a level is served so: few points a face, and no rings so large that their squares are not linear.
  static bool suits(const Lattice& lattice, const Stencils& stencils);

  PlateMatrix(const Lattice& lattice, const Stencils& stencils, const Unknowns& unknowns, Workers& workers);

  // Of control vertices, in place of earlier ones.
  void set_weights(const VertexWeights& weights);

  Array<float> inverse_diagonal();  // one number a point; 1 where it is no unknown

  const WrittenMatrix& rows() const { return rows_; }

 private:
  std::size_t points_;
  WrittenMatrix rows_;             // the diagonal comes first
  std::vector<float> unweighted_;  // the diagonal of control vertices
};

}  // namespace fairing
