// SPDX-License-Identifier: GPL-3.0-or-later
// The divided differences of one level, ring by ring and one column at a time, from which matrices
// are summed.
#pragma once

#include <cmath>
#include <vector>

#include "sparse/ring_table.h"
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
  double penalty(Index p) const { return surface_ ? double(surface_->penalty[p]) : 0; }
  const Stencils& stencils() const { return stencils_; }
  bool has_fit(const RingTable::Ring& ring) const { return stencils_.has_fit[ring.element]; }
  // For a ring with a fit: the three differences there of a unit at a member, without the root of
  // weight().
  Column column(const RingTable::Ring& ring, std::size_t slot) const {
    const auto e = std::size_t(ring.element);
    return column_[slot + (surface_ ? ring.member : stencils_.begin[e] + e)];
  }
  double weight(Index centre) const { return surface_ || weight_.empty() ? 1.0 : weight_[centre]; }

 private:
  const Stencils& stencils_;
  const SurfaceRows* surface_;
  const RingTable rings_;
  const Array<double> weight_;  // of the points; empty: all are one
  // By element, or on a surface by point: the centre's, then those of the neighbours.
  Array<Column> column_;
};

}  // namespace fairing
