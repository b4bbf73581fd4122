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

bool suits(const Lattice& lattice, const Stencils& stencils) {
  if (!has_rows(lattice.n(), lattice.size())) return false;
  std::size_t products = 81 * lattice.size();
  for (std::size_t v = 0; v + 1 < stencils.ring_offset.size(); ++v) {
    const auto size = std::size_t(stencils.ring_offset[v + 1] - stencils.ring_offset[v]);
    products += size * size;
  }
  return products < most_products * lattice.size();
}

}  // namespace

std::unique_ptr<PlateMatrix> PlateMatrix::make(const Lattice& lattice, const Stencils& stencils,
                                               const Unknowns& unknowns, Workers& workers) {
  if (!suits(lattice, stencils)) return nullptr;
  std::unique_ptr<PlateMatrix> matrix(new PlateMatrix(lattice, unknowns));
  const PlateRings plate(lattice, stencils, unknowns, workers);
  const auto writer = [&] { return [&plate](Index p, RowBuilder& row) { write_row(plate, p, row); }; };
  return matrix->rows_.build(workers, writer) ? std::move(matrix) : nullptr;
}

void PlateMatrix::set_weights(const VertexWeights& weights) {
  weight_.clear();
  for (std::size_t v = 0; v < weights.size(); ++v)
    weight_.insert(weight_.end(), 3, moves_[v] ? float(weights[v]) : 0.0f);
}

Array<float> PlateMatrix::inverse_diagonal(Workers& workers) const {
  Array<float> inverse(points_);
  workers.for_parts(points_, chunk_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const float diagonal = rows_.diagonal(p) + (3 * p < weight_.size() ? weight_[3 * p] : 0.0f);
      inverse[p] = diagonal > 0 ? 1 / diagonal : 1.0f;
    }
  });
  return inverse;
}

}  // namespace fairing
