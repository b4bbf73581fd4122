// SPDX-License-Identifier: GPL-3.0-or-later
// The divided differences of one level, ring by ring and one column at a time: what is assembled, or
// swept, point by point. About 200 bytes a point.
#pragma once

#include <cmath>

#include "sparse/ring_table.h"
#include "stencil/stencils.h"
#include "stencil/weights.h"
#include "thin_plate/surface_differences.h"

namespace fairing {

class PlateDifferences {
 public:
  using Column = EnergyRows::Column;

  // `grid` and `stencils` must outlive it, and `surface`, whose differences take the place of the
  // stencils' if it is given. Throws where the run has been cancelled.
  PlateDifferences(const GridLevel& grid, const Stencils& stencils, const Unknowns& unknowns,
                   Workers& workers, const SurfaceDifferences* surface = nullptr)
      : grid_(grid),
        stencils_(stencils),
        surface_(surface),
        rings_(grid, unknowns, workers),
        places_(rings_),
        weight_(point_weights(grid)) {}

  const GridLevel& grid() const { return grid_; }
  const RingTable& rings() const { return rings_; }
  const RingPlaces& places() const { return places_; }

  double pull(Index p) const { return surface_ ? surface_->pull(p) : 0.0; }

  // None where the point carries no fit.
  EnergyRows rows(Index centre) const {
    return {grid_.mesh(), stencils_, rings_.about(centre).element};
  }
  MembraneWeights membrane(Index centre) const {
    return {grid_.mesh(), stencils_, rings_.about(centre).element};
  }

  // What a unit at a member of the ring about `centre` does to the three differences there; `of`:
  // its rows().
  Column column(Index centre, const EnergyRows& of, std::size_t slot) const {
    if (surface_) return surface_->column(centre, slot);
    const double scale =
        grid_.n() * std::sqrt(weight_.empty() ? 1.0 : weight_[std::size_t(centre)]);
    Column out = {};
    if (slot == 0)
      for (std::size_t k = 0; k < of.size(); ++k)
        for (std::size_t c = 0; c < 3; ++c) out[c] -= scale * of[of.by_pairs(k)][c];
    else
      for (std::size_t c = 0; c < 3; ++c) out[c] = scale * of[slot - 1][c];
    return out;
  }

 private:
  const GridLevel& grid_;
  const Stencils& stencils_;
  const SurfaceDifferences* surface_;
  const RingTable rings_;
  const RingPlaces places_;
  const Array<double> weight_;  // of the points; empty: all are one
};

}  // namespace fairing
