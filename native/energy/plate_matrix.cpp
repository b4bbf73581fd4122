// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/plate_matrix.h"

#include "rows/limits.h"

namespace fairing {
namespace {

constexpr std::size_t most_products = 128;  // a point's rings by their sizes

// Row p of K, from the rings that hold the point: they are those about its own ring's members.
void write_row(const PlateRings& plate, Index p, RowBuilder& row) {
  const WrittenRings& rings = plate.rings();
  if (!rings.is_unknown(p)) return;
  row.add(p, 0);  // the diagonal comes first
  const WrittenRings::Ring& own = rings.about(p);
  for (std::size_t k = 0; k < own.size; ++k) {
    const Index centre = WrittenRings::id_of(rings.members(own)[k]);
    const WrittenRings::Ring* ring = plate.fit_about(centre);
    const std::size_t slot = ring ? rings.slot(*ring, p) : 0;
    if (!ring || slot == ring->size) continue;
    const WrittenRings::Member* members = rings.members(*ring);
    const double* numbers = plate.row(*ring, slot);
    const double weight = plate.weight(centre);
    for (std::size_t m = 0; m < ring->size; ++m)
      if (members[m] >= 0) row.add(members[m], weight * numbers[m]);
  }
}

}  // namespace

bool PlateMatrix::suits(const Lattice& lattice, const Stencils& stencils) {
  if (!has_rows(lattice.n(), lattice.size())) return false;
  std::size_t products = 81 * lattice.size();
  for (std::size_t v = 0; v + 1 < stencils.ring_offset.size(); ++v) {
    const auto size = std::size_t(stencils.ring_offset[v + 1] - stencils.ring_offset[v]);
    products += size * size;
  }
  return products < most_products * lattice.size();
}

PlateMatrix::PlateMatrix(const Lattice& lattice, const Stencils& stencils, const Unknowns& unknowns,
                         Workers& workers)
    : points_(lattice.size()), rows_(lattice.size(), lattice.size()) {
  const PlateRings plate(lattice, stencils, unknowns, workers);
  rows_.build(workers, [&](Index p, RowBuilder& row) { write_row(plate, p, row); });
  for (std::size_t v = 0; v < unknowns.vertex.size(); ++v) {
    const float* diagonal = rows_.first_number(v);
    unweighted_.push_back(diagonal ? *diagonal : 0);
  }
}

void PlateMatrix::set_weights(const VertexWeights& weights) {
  for (std::size_t v = 0; v < weights.size(); ++v)
    if (float* diagonal = rows_.first_number(v)) *diagonal = unweighted_[v] + float(weights[v]);
}

Array<float> PlateMatrix::inverse_diagonal() {
  Array<float> inverse(points_);
  for (std::size_t p = 0; p < points_; ++p) {
    const float* diagonal = rows_.first_number(p);
    inverse[p] = diagonal && *diagonal > 0 ? 1 / *diagonal : 1.0f;
  }
  return inverse;
}

}  // namespace fairing
