// SPDX-License-Identifier: GPL-3.0-or-later
// The divided differences of one level in the metric of a surface, a set of rows a point: what takes
// the place of those by control vertex, edge and face (stencil/stencils.h). The metric of the control
// faces has a cone at each control vertex and a kink along each control edge; a surface has none, so
// that the plate is nearly its total curvature (docs/developers/notes/method.md).
//
// Such a plate swings between the points that hold it, farther than a thin wall is thick. So it is drawn
// to a surface that does not, the goal: P, a weight a point, is part of the matrix, and P goal of what
// it is to come up to.
#pragma once

#include "sparse/ring_table.h"
#include "stencil/stencils.h"
#include "stencil/weights.h"

namespace fairing {

// The metric of a surface and the pull to the goal.
struct SurfaceMetric {
  const double* surface;  // 3 numbers a point
  // One a point, k: the squared distance from the goal weighs k^4 S^2 times what the surface itself bends
  // at the point, with S the area that this has at unit grid spacing.
  const float* pull;
  double exponent;  // as in flatten()
};

class SurfaceDifferences {
 public:
  using Column = EnergyRows::Column;

  // `metric`: of this level. Where its surface has no shape, the control metric's rows stay. The other
  // references must outlive it. Throws where the run has been cancelled.
  SurfaceDifferences(const GridLevel& grid, const Stencils& stencils, const SurfaceMetric& metric,
                     const Unknowns& unknowns, Workers& workers);

  // As PlateDifferences::column().
  Column column(Index centre, std::size_t slot) const {
    const float* row = row_.data() + 3 * (rings_.about(centre).member + slot);
    return {row[0], row[1], row[2]};
  }

  double pull(Index p) const { return double(pull_[std::size_t(p)]); }

  // y <- (K + P + W) x on the unknowns, zero elsewhere; T: float or double. `vertices`: which control
  // vertices count as such, in place of the level's own.
  template <class T>
  void apply(const std::vector<std::uint8_t>& vertices, const VertexWeights& weights,
             Workers& workers, const T* x, T* y);

  // The diagonal of K + P + W, where these control vertices count as unknowns: 1 on what is none.
  Array<float> diagonal(const std::vector<std::uint8_t>& vertices, const VertexWeights& weights,
                        Workers& workers) const;

  // r += P goal on the unknowns.
  void add_pull(const double* goal, Workers& workers, double* r) const;

  // As thin_plate_energy(): without P.
  double energy(Workers& workers, const double* x);

 private:
  void write_rows(const SurfaceMetric& metric, Workers& workers);
  template <class T>
  Array<T>& moments();
  // moments <- rows x, 9 numbers a point.
  template <class T>
  void take_moments(Workers& workers, const T* x);
  MembraneWeights membrane(Index p) const {
    return {grid_.mesh(), stencils_, rings_.about(p).element};
  }

  bool is_unknown(Index p) const { return unknown_[std::size_t(p)] != 0; }

  const GridLevel& grid_;
  const Stencils& stencils_;
  const std::vector<std::uint8_t> unknown_;  // one a point
  const RingTable rings_;                    // in which all points are
  const RingPlaces places_;
  Array<float> row_;   // 3 a member of a ring
  Array<float> pull_;  // P, one a point: none where it is no unknown
  Array<double> moment_;
  Array<float> float_moment_;
};

}  // namespace fairing
