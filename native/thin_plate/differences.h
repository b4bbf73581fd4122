// SPDX-License-Identifier: GPL-3.0-or-later
// The divided differences of one level, ring by ring and one column at a time, from which matrices
// are summed.
#pragma once

#include <cmath>
#include <vector>

#include "sparse/ring_table.h"
#include "stencil/stencils.h"
#include "stencil/weights.h"
#include "thin_plate/surface_differences.h"

namespace fairing {

class PlateDifferences {
 public:
  using Column = EnergyRows::Column;

  // `grid` and `stencils` must outlive it, and `surface`, whose differences replace those of the
  // stencils if it is given. Throws FairingError(cancelled).
  PlateDifferences(const GridLevel& grid, const Stencils& stencils, const Unknowns& unknowns,
                   Workers& workers, const SurfaceDifferences* surface = nullptr);

  const RingTable& rings() const { return rings_; }
  // Whether points have weights besides the stencils.
  bool is_weighted() const { return surface_ || !weight_.empty(); }
  double penalty(Index p) const { return surface_ ? surface_->penalty(p) : 0.0; }
  MembraneWeights membrane(const RingTable::Ring& ring) const {
    return {mesh_, stencils_, ring.element};
  }

  bool has_fit(const RingTable::Ring& ring) const {
    return begin_[std::size_t(ring.element)] != none;
  }
  // For a ring with a fit: the three differences there of a unit at a member, without the root of
  // weight().
  Column column(Index centre, const RingTable::Ring& ring, std::size_t slot) const {
    if (surface_) return surface_->column(centre, slot);
    return column_[begin_[std::size_t(ring.element)] + slot];
  }
  double weight(Index centre) const {
    return surface_ || weight_.empty() ? 1.0 : weight_[std::size_t(centre)];
  }

 private:
  static constexpr std::size_t none = std::size_t(-1);

  const ControlMesh& mesh_;
  const Stencils& stencils_;
  const SurfaceDifferences* surface_;
  const RingTable rings_;
  const Array<double> weight_;      // of the points; empty: all are one
  std::vector<std::size_t> begin_;  // by element: the begin of its columns, the centre's first
  Array<Column> column_;
};

}  // namespace fairing
