// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/matrix.h"

#include <cmath>

#include "parallel/reductions.h"
#include "sparse/repeated_rows.h"
#include "thin_plate/differences.h"

namespace fairing {
namespace {

// Row p of K, from the rings that contain the point: those of its own ring's members.
void sum_row(const PlateDifferences& plate, Index p, RowBuilder& row) {
  const RingTable& rings = plate.rings();
  const RingTable::Ring& own = rings.about(p);
  for (std::size_t k = 0; k < own.size; ++k) {
    const Index centre = RingTable::id_of(rings.members(own)[k]);
    const RingTable::Ring& ring = rings.about(centre);
    const std::size_t slot = plate.has_fit(ring) ? rings.slot(ring, p) : ring.size;
    if (slot == ring.size) continue;
    const RingTable::Member* members = rings.members(ring);
    const auto at = plate.column(ring, slot);
    const double weight = plate.weight(centre);
    for (std::size_t m = 0; m < ring.size; ++m) {
      if (members[m] < 0) continue;
      const auto to = plate.column(ring, m);
      row.add(members[m], weight * (at[0] * to[0] + at[1] * to[1] + at[2] * to[2]));
    }
  }
  const std::span<const double> tension = plate.stencils().weights(own.element);
  for (std::size_t k = 0; k < tension.size(); ++k)
    if (const RingTable::Member q = rings.members(own)[k + 1]; q >= 0) row.add(q, -tension[k]);
  const double extra = plate.stencils().total_weight(own.element) + plate.penalty(p);
  if (extra != 0) row.add(p, extra);
}

// Rows of K one after another.
class PlateRows {
 public:
  explicit PlateRows(const PlateDifferences& plate) : plate_(plate), repeated_(plate.rings()) {}

  void write(Index p, RowBuilder& row) {
    if (!plate_.rings().is_unknown(p)) return;
    if (plate_.is_weighted()) return sum_row(plate_, p, row);
    if (repeated_.write(p, row)) return;
    sum_row(plate_, p, row);
    repeated_.keep(p, row);
  }

 private:
  const PlateDifferences& plate_;
  RepeatedRows repeated_;
};

bool suits(const GridLevel& grid, const Stencils& stencils) {
  std::size_t products = 81 * grid.size();
  for (Index v = 0; v < grid.mesh().vertex_count(); ++v) {
    const std::size_t size = stencils.columns(v).size();
    products += size * size;
  }
  return worth_products(products, grid.size());
}

}  // namespace

std::unique_ptr<PlateMatrix> PlateMatrix::make(const GridLevel& grid, const Stencils& stencils,
                                               const Unknowns& unknowns, Workers& workers,
                                               const SurfaceRows* surface) {
  if (!has_rows(grid.n(), grid.size()) || !suits(grid, stencils)) return nullptr;
  const PlateDifferences plate(grid, stencils, unknowns, workers, surface);
  const auto writer = [&] {
    return [rows = PlateRows(plate)](Index p, RowBuilder& row) mutable { rows.write(p, row); };
  };
  auto rows = AssembledMatrix::make(grid.size(), grid.size(), workers, writer);
  if (!rows) return nullptr;
  return std::unique_ptr<PlateMatrix>(new PlateMatrix(unknowns, grid.size(), std::move(rows)));
}

void PlateMatrix::set_weights(const VertexWeights& weights) {
  weight_.clear();
  for (std::size_t v = 0; v < weights.size(); ++v)
    weight_.insert(weight_.end(), 3, v >= moves_.size() || moves_[v] ? float(weights[v]) : 0.0f);
}

void PlateMatrix::write_lines(const Array<float>& inverse_diagonal, LineBand& band,
                              Workers& workers) const {
  const auto offer = [&] {
    Array<float> root(points_);
    for_each_index(workers, points_,
                   [&](std::size_t p) { root[p] = std::sqrt(inverse_diagonal[p]); });
    rows_->visit_numbers(workers, [&](Index p, Index q, float number) {
      if (p != q) band.offer(p, q, std::abs(number) * root[p] * root[q]);
    });
  };
  band.write(offer, [&] {
    rows_->visit_numbers(workers, [&](Index p, Index q, float number) { band.add(p, q, number); });
  });
}

Array<float> PlateMatrix::inverse_diagonal(Workers& workers) const {
  Array<float> inverse(points_);
  workers.for_each(points_, chunk_rows, [&](std::size_t p) {
    const float diagonal = rows_->diagonal(p) + (3 * p < weight_.size() ? weight_[3 * p] : 0.0f);
    inverse[p] = diagonal > 0 ? 1 / diagonal : 1.0f;
  });
  return inverse;
}

}  // namespace fairing
