// SPDX-License-Identifier: GPL-3.0-or-later
// The thin-plate energy E(p) = sum_i w_i (|G_uu p|^2 + 2 |G_uv p|^2 + |G_vv p|^2) of [Kobbelt
// 1997a, §4] on one level, without a matrix: half its gradient, K p with K = G^T W G, is two
// one-ring passes. x, y and z share K. With a membrane (stencil/membrane.h), its L is part of K.
#pragma once

#include "grid/accumulate.h"
#include "parallel/reductions.h"
#include "stencil/stencils.h"
#include "stencil/weights.h"
#include "thin_plate/surface_rows.h"

namespace fairing {

// The rows of all levels in the precision of a pass. `stencils` must outlive them.
template <class T>
struct ThinPlateRows {
  ThinPlateRows(const ControlMesh& mesh, const Stencils& stencils);

  const Stencils& stencils;
  Array<T> ring;  // 3 a neighbour of vertices and edges, as in Stencils
  Array<T> face;  // the matrix C of the density d^T C d: 4 x 4 per face
};

// All functions throw FairingError(cancelled). Vectors hold 3 numbers a point of the level; results
// do not depend on the number of threads, bit for bit. With `surface`, its rows replace those of
// the stencils, and its penalties P are part of W.

// y <- (K + W) x on the unknowns of a level, zero elsewhere. W has the weights of control vertices
// or of all points: 0 on points that are not unknowns, except control vertices. T: float or double.
// In float, which serves the smoother, fourth differences lose as many digits as n^4 has.
template <class T>
void apply_thin_plate(const GridLevel& grid, const ThinPlateRows<T>& rows, const Unknowns& unknowns,
                      const VertexWeights& weights, Workers& workers, ElementSlots<T>& slots,
                      const T* x, T* y, const SurfaceRows* surface = nullptr);

// y += W x on the unknowns.
template <class T, class Weights>
void add_weighted(const Unknowns& unknowns, const Weights& weights, Workers& workers, const T* x,
                  T* y) {
  for_each_index(workers, weights.size(), [&](std::size_t p) {
    if (p < unknowns.vertex.size() && !unknowns.vertex[p]) return;
    for (std::size_t a = 0; a < 3; ++a) y[3 * p + a] += T(weights[p]) * x[3 * p + a];
  });
}

// The diagonal of K: one number a point; 0 if the point is not an unknown.
Array<float> thin_plate_diagonal(const GridLevel& grid, const Stencils& stencils,
                                 const Unknowns& unknowns, Workers& workers,
                                 ElementSlots<double>& slots, const SurfaceRows* surface = nullptr);

// E(x) over all points, without the control vertices' weights and the membrane.
double thin_plate_energy(const GridLevel& grid, const Stencils& stencils, Workers& workers,
                         const double* x, const SurfaceRows* surface = nullptr);

// x . L x over all points, with the membrane's L.
double membrane_energy(const GridLevel& grid, const Stencils& stencils, Workers& workers,
                       const double* x);

}  // namespace fairing
