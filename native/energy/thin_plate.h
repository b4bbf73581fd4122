// SPDX-License-Identifier: GPL-3.0-or-later
// The thin-plate energy E(p) = sum_i w_i (|G_uu p|^2 + 2 |G_uv p|^2 + |G_vv p|^2) of [Kobbelt 1997a, §4] on one level,
// without a matrix: its gradient's half, K p with K = G^T W G, is two one-ring passes. x, y and z share K.
#pragma once

#include "difference/stencils.h"
#include "lattice/accumulate.h"

namespace fairing {

// The rows of all levels in the precision that a pass works in.
template <class T>
struct ThinPlateRows {
  ThinPlateRows(const ControlMesh& mesh, const Stencils& stencils);

  const Stencils& stencils;
  Array<T> vertex, edge;  // laid out as in Stencils
  Array<T> face;          // the matrix C of the density d^T C d: 4 x 4 a face
};

// Weights that hold control vertices near their given positions: w |p - c|^2 is added to the energy.
using VertexWeights = std::vector<double>;  // empty: none

// y <- K x on the unknowns of a level, zero elsewhere. Vectors hold 3 numbers a point.
template <class T>
void apply_thin_plate(const Lattice& lattice, const ThinPlateRows<T>& rows, const Unknowns& unknowns,
                      const VertexWeights& weights, Workers& workers, Exchange<T>& exchange, const T* x,
                      T* y);

// The diagonal of K: one number a point; 1 where the point is no unknown.
Array<float> thin_plate_diagonal(const Lattice& lattice, const ThinPlateRows<double>& rows,
                                 const Unknowns& unknowns, const VertexWeights& weights, Workers& workers,
                                 Exchange<double>& exchange);

// E(x) over all points, without the part of the control vertices' weights.
double thin_plate_energy(const Lattice& lattice, const ThinPlateRows<double>& rows, Workers& workers,
                         const double* x);

}  // namespace fairing
