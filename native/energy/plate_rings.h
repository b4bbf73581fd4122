// SPDX-License-Identifier: GPL-3.0-or-later
// The divided differences of the thin plate on one level, as what they contribute to the rows of K.
#pragma once

#include "energy/joint_weight.h"
#include "energy/thin_plate.h"
#include "rows/rings.h"

namespace fairing {

class PlateRings {
 public:
  PlateRings(const Lattice& lattice, const Stencils& stencils, const Unknowns& unknowns, Workers& workers);

  const WrittenRings& rings() const { return rings_; }
  // The ring about a point that carries a fit; null: it does not.
  const WrittenRings::Ring* fit_about(Index p) const {
    const WrittenRings::Ring& ring = rings_.about(p);
    return gram_begin_[std::size_t(ring.element)] != none ? &ring : nullptr;
  }
  // Row s of J^T J: what a unit at member s does to half the energy's gradient at all members, but for the weight.
  const double* row(const WrittenRings::Ring& ring, std::size_t s) const {
    return gram_.data() + gram_begin_[std::size_t(ring.element)] + s * ring.size;
  }
  double weight(Index p) const { return weight_.empty() ? 1.0 : weight_[std::size_t(p)]; }

 private:
  static constexpr std::size_t none = std::size_t(-1);
  void write_grams(const Stencils& stencils);
  void write_weights();

  const Lattice& lattice_;
  JointWeight joint_;
  WrittenRings rings_;
  std::vector<std::size_t> gram_begin_;  // per element
  Array<double> gram_;
  Array<double> weight_;  // per point; empty: all are one
};

}  // namespace fairing
