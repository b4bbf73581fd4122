// SPDX-License-Identifier: GPL-3.0-or-later
// The thin-plate energy E(p) = sum_i w_i (|G_uu p|^2 + 2 |G_uv p|^2 + |G_vv p|^2) of [Kobbelt
// 1997a, §4] on one level, without a matrix: its gradient's half, K p with K = G^T W G, is two
// one-ring passes. x, y and z share K. Where the stencils have a membrane (stencil/membrane.h), its
// L is part of K.
#pragma once

#include "grid/accumulate.h"
#include "multigrid/line_band.h"
#include "stencil/stencils.h"
#include "stencil/weights.h"

namespace fairing {

// The rows of all levels in the precision that a pass works in. `stencils` must outlive them.
template <class T>
struct ThinPlateRows {
  ThinPlateRows(const ControlMesh& mesh, const Stencils& stencils);

  const Stencils& stencils;
  Array<T> vertex, edge;  // laid out as in Stencils
  Array<T> face;          // the matrix C of the density d^T C d: 4 x 4 a face
};

// All functions throw where the run has been cancelled. Vectors hold 3 numbers a point of the
// level; results are the same for any number of threads, bit for bit.

// y <- (K + W) x on the unknowns of a level, zero elsewhere, with W the weights of control
// vertices, or of all points: 0 on those that are no unknowns, but for control vertices. T: float or double. In float, fourth differences lose as many digits as n^4 has: see
// most_of_single (multigrid/level_operator.h).
template <class T>
void apply_thin_plate(const GridLevel& grid, const ThinPlateRows<T>& rows, const Unknowns& unknowns,
                      const VertexWeights& weights, Workers& workers, ElementSlots<T>& slots,
                      const T* x, T* y);

// The diagonal of K + W: one number a point; 1 where the point is no unknown.
Array<float> thin_plate_diagonal(const GridLevel& grid, const Stencils& stencils,
                                 const Unknowns& unknowns, const VertexWeights& weights,
                                 Workers& workers, ElementSlots<double>& slots);

// As LevelOperator::write_lines(), without the membrane.
void write_plate_lines(const GridLevel& grid, const Stencils& stencils, const Unknowns& unknowns,
                       const Array<float>& inverse_diagonal, Workers& workers, LineBand& band);

// E(x) over all points, unknowns or not, without the parts of the control vertices' weights and of
// the membrane (thin_plate/membrane.h).
double thin_plate_energy(const GridLevel& grid, const Stencils& stencils, Workers& workers,
                         const double* x);

}  // namespace fairing
