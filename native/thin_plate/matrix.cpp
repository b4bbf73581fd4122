// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/matrix.h"

#include <cmath>

#include "multigrid/assembly.h"
#include "parallel/cancel.h"
#include "parallel/reductions.h"
#include "sparse/repeated_rows.h"
#include "sparse/unknown_points.h"
#include "stencil/weights.h"

namespace fairing {
namespace {

// The divided differences of one level, ring by ring and one column at a time, from which matrices
// are summed.
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

PlateDifferences::PlateDifferences(const GridLevel& grid, const Stencils& stencils,
                                   const Unknowns& unknowns, Workers& workers,
                                   const SurfaceDifferences* surface)
    : mesh_(grid.mesh()),
      stencils_(stencils),
      surface_(surface),
      rings_(grid, unknowns, workers),
      weight_(point_weights(grid)) {
  const double scale = grid.n();
  const auto elements = std::size_t(mesh_.vertex_count()) + mesh_.edges.size() + mesh_.faces.size();
  for (std::size_t element = 0; element < elements; ++element) {
    stop_if_cancelled(element);
    const EnergyRows rows(mesh_, stencils, Index(element));
    const std::size_t begin = column_.size();
    begin_.push_back(rows.size() > 0 ? begin : none);
    if (rows.size() == 0) continue;
    column_.insert(column_.end(), 1 + rows.size(), Column{});
    for (std::size_t k = 0; k < rows.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        column_[begin + 1 + k][c] = scale * rows[k][c];
        column_[begin][c] -= scale * rows[rows.by_pairs(k)][c];
      }
  }
}

// The rows of all points, in order.
void visit_rows(const PlateDifferences& plate, const VisitRows& visit) {
  std::vector<Index> ring_points;
  std::vector<double> numbers;
  for (std::size_t p = 0; p < plate.rings().points(); ++p) {
    stop_if_cancelled(p);
    const RingTable::Ring& ring = plate.rings().about(Index(p));
    ring_points.clear();
    numbers.clear();
    const double root = std::sqrt(plate.weight(Index(p)));
    for (std::size_t s = 0; s < ring.size && plate.has_fit(ring); ++s) {
      ring_points.push_back(RingTable::id_of(plate.rings().members(ring)[s]));
      for (const double number : plate.column(Index(p), ring, s)) numbers.push_back(root * number);
    }
    visit(ring_points, numbers);
  }
}

// Calls visit(member, number) for a point's row of the membrane, on the unknowns of its ring.
template <class Visit>
void visit_membrane_row(const MembraneWeights& weights, const RingTable::Member* members,
                        Visit&& visit) {
  if (weights.size() == 0) return;
  visit(members[0], weights.total());
  for (std::size_t k = 0; k < weights.size(); ++k)
    if (members[k + 1] >= 0) visit(members[k + 1], -weights[k]);
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
    const auto at = plate.column(centre, ring, slot);
    const double weight = plate.weight(centre);
    for (std::size_t m = 0; m < ring.size; ++m) {
      if (members[m] < 0) continue;
      const auto to = plate.column(centre, ring, m);
      row.add(members[m], weight * (at[0] * to[0] + at[1] * to[1] + at[2] * to[2]));
    }
  }
  visit_membrane_row(plate.membrane(own), rings.members(own),
                     [&](RingTable::Member m, double number) { row.add(m, number); });
  if (const double penalty = plate.penalty(p); penalty != 0) row.add(p, penalty);
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
  for (std::size_t v = 0; v + 1 < stencils.ring_offset.size(); ++v) {
    const auto size = std::size_t(stencils.ring_offset[v + 1] - stencils.ring_offset[v]);
    products += size * size;
  }
  return worth_products(products, grid.size());
}

}  // namespace

AssembledSystem assemble_thin_plate(const GridLevel& grid, const Stencils& stencils,
                                    const Unknowns& unknowns, const VertexWeights& weights,
                                    Workers& workers, const SurfaceDifferences* surface) {
  const PlateDifferences plate(grid, stencils, unknowns, workers, surface);
  const std::vector<Index> number = number_unknowns(grid, unknowns);
  AssembledSystem system = assemble_square(
      grid, number, nullptr, [&](const VisitRows& visit) { visit_rows(plate, visit); });
  Triplets entries;
  for (Index i = 0; i < Index(system.unknown_points.size()); ++i) {
    const Index p = system.unknown_points[std::size_t(i)];
    const RingTable::Ring& ring = plate.rings().about(p);
    const MembraneWeights membrane = plate.membrane(ring);
    for (std::size_t k = 0; k < membrane.size(); ++k)
      if (const RingTable::Member q = plate.rings().members(ring)[k + 1]; q >= 0)
        entries.emplace_back(i, number[std::size_t(q)], -membrane[k]);
    const double held = std::size_t(p) < weights.size() ? weights[std::size_t(p)] : 0.0;
    if (const double own = membrane.total() + held + plate.penalty(p); own != 0)
      entries.emplace_back(i, i, own);
  }
  if (!entries.empty()) add_entries(entries, system);
  return system;
}

std::unique_ptr<PlateMatrix> PlateMatrix::make(const GridLevel& grid, const Stencils& stencils,
                                               const Unknowns& unknowns, Workers& workers,
                                               const SurfaceDifferences* surface) {
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
      if (p != q) band.offer(p, q, std::abs(number) * root[std::size_t(p)] * root[std::size_t(q)]);
    });
  };
  band.write(offer, [&] {
    rows_->visit_numbers(workers, [&](Index p, Index q, float number) { band.add(p, q, number); });
  });
}

Array<float> PlateMatrix::inverse_diagonal(Workers& workers) const {
  Array<float> inverse(points_);
  workers.for_parts(points_, chunk_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const float diagonal = rows_->diagonal(p) + (3 * p < weight_.size() ? weight_[3 * p] : 0.0f);
      inverse[p] = diagonal > 0 ? 1 / diagonal : 1.0f;
    }
  });
  return inverse;
}

}  // namespace fairing
