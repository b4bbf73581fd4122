// SPDX-License-Identifier: GPL-3.0-or-later
// The divided differences of one level in the metric of a surface, a set of rows for each point;
// they replace the rows by control vertex, edge and face (stencil/stencils.h). The metric of the
// control faces has a cone at each control vertex and a kink along each control edge. A surface has
// none, so the plate is close to its total curvature (docs/developers/notes/method.md).
//
// Such a plate oscillates between its fixed points, by more than the thickness of a thin wall. So
// its squared distance from a surface that does not is penalized, the reference: P, a weight for
// each point, is part of the matrix, and P reference of the right-hand side.
#pragma once

#include "sparse/ring_table.h"
#include "stencil/stencils.h"
#include "stencil/weights.h"

namespace fairing {

// The metric of a surface and the penalty on the distance from the reference.
struct SurfaceMetric {
  const double* surface;  // 3 numbers a point
  // k, one per point: the squared distance from the reference has the weight k^4 S^2 times the
  // surface's own bending at the point, with S the point's area at unit grid spacing.
  const float* penalty;
  double exponent;  // as in flatten()
};

class SurfaceDifferences {
 public:
  using Column = EnergyRows::Column;

  // `metric`: of this level. Where its surface is degenerate, the rows of the control metric
  // remain. The other references must outlive it. Throws FairingError(cancelled).
  SurfaceDifferences(const GridLevel& grid, const Stencils& stencils, const SurfaceMetric& metric,
                     const Unknowns& unknowns, Workers& workers);

  // As PlateDifferences::column().
  Column column(Index centre, std::size_t slot) const {
    const float* row = row_.data() + 3 * (rings_.about(centre).member + slot);
    return {row[0], row[1], row[2]};
  }

  double penalty(Index p) const { return double(penalty_[std::size_t(p)]); }

  // y <- (K + P + W) x on the unknowns, zero elsewhere; T: float or double. `vertices`: which
  // control vertices count as unknowns, in place of the level's own.
  template <class T>
  void apply(const std::vector<std::uint8_t>& vertices, const VertexWeights& weights,
             Workers& workers, const T* x, T* y);

  // The diagonal of K + P + W, with these control vertices among the unknowns; 1 on all other
  // points.
  Array<float> diagonal(const std::vector<std::uint8_t>& vertices, const VertexWeights& weights,
                        Workers& workers) const;

  // r += P reference on the unknowns.
  void add_penalty(const double* reference, Workers& workers, double* r) const;

  // As thin_plate_energy(), without P.
  double energy(Workers& workers, const double* x);

 private:
  void write_rows(const SurfaceMetric& metric, Workers& workers);
  template <class T>
  Array<T>& moments();
  // moments <- rows x, 9 numbers a point.
  template <class T>
  void compute_moments(Workers& workers, const T* x);
  MembraneWeights membrane(Index p) const {
    return {grid_.mesh(), stencils_, rings_.about(p).element};
  }

  bool is_unknown(Index p) const { return unknown_[std::size_t(p)] != 0; }

  const GridLevel& grid_;
  const Stencils& stencils_;
  const std::vector<std::uint8_t> unknown_;  // one a point
  const RingTable rings_;                    // in which all points are
  const RingPlaces places_;
  Array<float> row_;      // 3 a member of a ring
  Array<float> penalty_;  // P, one per point: zero if it is not an unknown
  Array<double> moment_;
  Array<float> float_moment_;
};

}  // namespace fairing
