// SPDX-License-Identifier: GPL-3.0-or-later
// The divided differences of one level as rows over its rings, in the form that K is summed from
// (sparse/ring_matrix.h).
#pragma once

#include <cmath>
#include <vector>

#include "multigrid/level_operator.h"
#include "sparse/ring_matrix.h"
#include "stencil/stencils.h"
#include "stencil/weights.h"
#include "thin_plate/surface_rows.h"

namespace fairing {

class PlateDifferences {
 public:
  using Column = Stencils::Column;

  // `grid` and `stencils` must outlive it, and `surface`, whose differences replace those of the
  // stencils if it is given. Throws FairingError(cancelled).
  PlateDifferences(const GridLevel& grid, const Stencils& stencils, const Unknowns& unknowns,
                   Workers& workers, const SurfaceRows* surface = nullptr);

  const RingTable& rings() const { return rings_; }
  bool has_rows(const RingTable::Ring& ring) const { return stencils_.has_fit[ring.element]; }
  // For a ring with a fit: the three differences there of a unit at a member, without the root of
  // weight().
  Column column(const RingTable::Ring& ring, std::size_t slot) const {
    const auto e = std::size_t(ring.element);
    return column_[slot + (surface_ ? ring.member : stencils_.begin[e] + e)];
  }
  double weight(Index centre) const { return surface_ || weight_.empty() ? 1.0 : weight_[centre]; }
  // The membrane and the penalty.
  void add_own(Index p, RowSum& sum) const;

 private:
  const Stencils& stencils_;
  const SurfaceRows* surface_;
  const RingTable rings_;
  const Array<double> weight_;  // of the points; empty: all are one
  // By element, or on a surface by point: the centre's, then those of the neighbours.
  Array<Column> column_;
};

// K with the control vertices' weights in double, with the differences of a surface if given: for
// the direct solve on the coarsest level, the paper's Gauss-Seidel sweeps, and tests of the passes.
// Throws if the run is cancelled.
AssembledSystem assemble_thin_plate(const GridLevel& grid, const Stencils& stencils,
                                    const Unknowns& unknowns, const VertexWeights& weights,
                                    Workers& workers, const SurfaceRows* surface = nullptr);

}  // namespace fairing
