// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/matrix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "parallel/reductions.h"
#include "thin_plate/differences.h"

namespace fairing {
namespace {

// For a stretch of rows that are summed from the rings around a point's own ring, weighted by
// numbers of each ring's element alone.
class RepeatedRows {
 public:
  // `rings` must outlive it.
  explicit RepeatedRows(const RingTable& rings) : rings_(rings) {}

  // Whether the row of the unknown p equals one of the latest; if so, writes it.
  bool write(Index p, RowBuilder& row);

  // Keeps the row of p, which has just been summed, if others may be equal.
  void keep(Index p, const RowBuilder& row);

 private:
  struct Known {
    std::vector<Index> element;       // whose stencils the rings have; empty: no row yet
    std::vector<std::uint8_t> slot;   // of the point in each of these rings
    std::vector<std::uint8_t> place;  // column of each ring's members, or one of the marks
    std::size_t columns = 0;
    RowBuilder::Numbers numbers;
  };
  enum Mark : std::uint8_t { in_no_row = 254, fixed = 255 };

  bool is_again(const Known& known, Index p);

  const RingTable& rings_;
  // A quad has five such rows in turns: deep inside, and along each side.
  std::array<Known, 5> known_;
  std::array<std::uint8_t, 5> latest_{0, 1, 2, 3, 4};  // into known_, most recently used first
  std::vector<Index> column_;
};

bool RepeatedRows::write(Index p, RowBuilder& row) {
  const auto again = std::find_if(latest_.begin(), latest_.end(),
                                  [&](std::uint8_t k) { return is_again(known_[k], p); });
  if (again == latest_.end() || !row.repeat(known_[*again].numbers, column_)) return false;
  std::rotate(latest_.begin(), again, again + 1);
  return true;
}

// Leaves the row's columns in column_.
bool RepeatedRows::is_again(const Known& known, Index p) {
  const RingTable::Ring& own = rings_.about(p);
  if (known.element.size() != own.size || known.element[0] != own.element) return false;
  const RingTable::Member* const centres = rings_.members(own);
  for (std::size_t k = 1; k < own.size; ++k)
    if (rings_.about(RingTable::id_of(centres[k])).element != known.element[k]) return false;
  column_.assign(known.columns, -1);
  const std::uint8_t* place = known.place.data();
  for (std::size_t k = 0; k < own.size; ++k) {
    const RingTable::Ring& ring = rings_.about(RingTable::id_of(centres[k]));
    const RingTable::Member* const members = rings_.members(ring);
    if (members[known.slot[k]] != p) return false;
    for (std::size_t m = 0; m < ring.size; ++m, ++place) {
      if (*place == fixed ? members[m] >= 0 : members[m] < 0) return false;
      if (*place >= in_no_row) continue;
      Index& column = column_[*place];
      if (column >= 0 && column != members[m]) return false;
      column = members[m];
    }
  }
  return true;
}

// A vertex has one ring, and its row and those next to it are not repeated.
void RepeatedRows::keep(Index p, const RowBuilder& row) {
  const RingTable::Ring& own = rings_.about(p);
  const RingTable::Member* const centres = rings_.members(own);
  for (std::size_t k = 0; k < own.size; ++k) {
    const RingTable::Ring& ring = rings_.about(RingTable::id_of(centres[k]));
    if (rings_.is_about_vertex(ring) || rings_.slot(ring, p) == ring.size) return;
  }
  std::rotate(latest_.begin(), latest_.end() - 1, latest_.end());
  Known& known = known_[latest_[0]];
  known.element.clear();
  known.slot.clear();
  known.place.clear();
  for (std::size_t k = 0; k < own.size; ++k) {
    const RingTable::Ring& ring = rings_.about(RingTable::id_of(centres[k]));
    known.element.push_back(ring.element);
    known.slot.push_back(std::uint8_t(rings_.slot(ring, p)));
    for (std::size_t m = 0; m < ring.size; ++m) {
      const RingTable::Member member = rings_.members(ring)[m];
      std::uint8_t place = member < 0 ? fixed : in_no_row;
      if (member >= 0 && row.names(member)) place = std::uint8_t(row.place(member));
      known.place.push_back(place);
    }
  }
  known.columns = row.columns();
  row.copy_numbers(known.numbers);
}

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
  if (!has_rows(grid.n(), grid.size(), surface != nullptr) || !suits(grid, stencils))
    return nullptr;
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
