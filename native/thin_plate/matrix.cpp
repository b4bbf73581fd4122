// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/matrix.h"

#include <cmath>

#include "parallel/cancel.h"
#include "parallel/reductions.h"
#include "sparse/repeated_rows.h"

namespace fairing {
namespace {

using Column = EnergyRows::Column;

// Calls visit(member, number) for the membrane's row of a point, on the unknowns of its ring.
template <class Visit>
void visit_membrane_row(const MembraneWeights& weights, const RingTable::Member* members,
                        Visit&& visit) {
  if (weights.size() == 0) return;
  visit(members[0], weights.total());
  for (std::size_t k = 0; k < weights.size(); ++k)
    if (members[k + 1] >= 0) visit(members[k + 1], -weights[k]);
}

// The divided differences of one level as what they contribute to the rows of K.
class PlateRings {
 public:
  PlateRings(const GridLevel& grid, const Stencils& stencils, const Unknowns& unknowns,
             Workers& workers)
      : mesh_(grid.mesh()),
        stencils_(stencils),
        rings_(grid, unknowns, workers),
        weight_(point_weights(grid)) {
    write_grams(grid, stencils);
  }

  const RingTable& rings() const { return rings_; }
  // The ring about a point that carries a fit; null: it does not.
  const RingTable::Ring* fit_about(Index p) const {
    const RingTable::Ring& ring = rings_.about(p);
    return gram_begin_[std::size_t(ring.element)] != none ? &ring : nullptr;
  }
  // Row s of J^T J: what a unit at member s does to half the energy's gradient at all members, but
  // for the weight.
  const double* row(const RingTable::Ring& ring, std::size_t s) const {
    return gram_.data() + gram_begin_[std::size_t(ring.element)] + s * ring.size;
  }
  bool is_weighted() const { return !weight_.empty(); }
  double weight(Index p) const { return weight_.empty() ? 1.0 : weight_[std::size_t(p)]; }
  MembraneWeights membrane(const RingTable::Ring& ring) const {
    return {mesh_, stencils_, ring.element};
  }

 private:
  static constexpr std::size_t none = std::size_t(-1);

  void write_grams(const GridLevel& grid, const Stencils& stencils) {
    const ControlMesh& mesh = grid.mesh();
    const double scale = double(grid.n()) * grid.n();
    const auto elements = std::size_t(mesh.vertex_count()) + mesh.edges.size() + mesh.faces.size();
    std::vector<Column> column;  // the centre's first
    for (std::size_t element = 0; element < elements; ++element) {
      stop_if_cancelled(element);
      const EnergyRows rows(mesh, stencils, Index(element));
      gram_begin_.push_back(rows.size() > 0 ? gram_.size() : none);
      if (rows.size() == 0) continue;
      column.assign(1, {});
      for (std::size_t k = 0; k < rows.size(); ++k) {
        column.push_back(rows[k]);
        for (std::size_t c = 0; c < 3; ++c) column[0][c] -= column.back()[c];
      }
      for (const Column& s : column)
        for (const Column& m : column)
          gram_.push_back(scale * (s[0] * m[0] + s[1] * m[1] + s[2] * m[2]));
    }
  }

  const ControlMesh& mesh_;
  const Stencils& stencils_;
  RingTable rings_;
  Array<double> weight_;                 // per point; empty: all are one
  std::vector<std::size_t> gram_begin_;  // per element
  Array<double> gram_;
};

// Row p of K, from the rings that hold the point: they are those about its own ring's members.
void sum_row(const PlateRings& plate, Index p, RowBuilder& row) {
  const RingTable& rings = plate.rings();
  const RingTable::Ring& own = rings.about(p);
  for (std::size_t k = 0; k < own.size; ++k) {
    const Index centre = RingTable::id_of(rings.members(own)[k]);
    const RingTable::Ring* ring = plate.fit_about(centre);
    const std::size_t slot = ring ? rings.slot(*ring, p) : 0;
    if (!ring || slot == ring->size) continue;
    const RingTable::Member* members = rings.members(*ring);
    const double* numbers = plate.row(*ring, slot);
    const double weight = plate.weight(centre);
    for (std::size_t m = 0; m < ring->size; ++m)
      if (members[m] >= 0) row.add(members[m], weight * numbers[m]);
  }
  visit_membrane_row(plate.membrane(own), rings.members(own),
                     [&](RingTable::Member m, double number) { row.add(m, number); });
}

// Rows of K one after another.
class PlateRows {
 public:
  explicit PlateRows(const PlateRings& plate) : plate_(plate), repeated_(plate.rings()) {}

  void write(Index p, RowBuilder& row) {
    if (!plate_.rings().is_unknown(p)) return;
    if (plate_.is_weighted()) return sum_row(plate_, p, row);
    if (repeated_.write(p, row)) return;
    sum_row(plate_, p, row);
    repeated_.keep(p, row);
  }

 private:
  const PlateRings& plate_;
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

std::unique_ptr<PlateMatrix> PlateMatrix::make(const GridLevel& grid, const Stencils& stencils,
                                               const Unknowns& unknowns, Workers& workers) {
  if (!has_rows(grid.n(), grid.size()) || !suits(grid, stencils)) return nullptr;
  const PlateRings plate(grid, stencils, unknowns, workers);
  const auto writer = [&] {
    return [rows = PlateRows(plate)](Index p, RowBuilder& row) mutable { rows.write(p, row); };
  };
  return make(unknowns, grid.size(),
              AssembledMatrix::make(grid.size(), grid.size(), workers, writer));
}

std::unique_ptr<PlateMatrix> PlateMatrix::make(const GridLevel& grid,
                                               const SurfaceDifferences& surface,
                                               const Unknowns& unknowns, Workers& workers) {
  if (!has_rows(grid.n(), grid.size()) || !worth_products(surface.products(), grid.size()))
    return nullptr;
  const auto writer = [&] {
    return [&surface](Index p, RowBuilder& row) { surface.write_row(p, row); };
  };
  return make(unknowns, grid.size(),
              AssembledMatrix::make(grid.size(), grid.size(), workers, writer));
}

std::unique_ptr<PlateMatrix> PlateMatrix::make(const Unknowns& unknowns, std::size_t points,
                                               Rows rows) {
  if (!rows) return nullptr;
  return std::unique_ptr<PlateMatrix>(new PlateMatrix(unknowns, points, std::move(rows)));
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
