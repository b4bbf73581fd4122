// SPDX-License-Identifier: GPL-3.0-or-later
// assemble_thin_plate(): column by column, each from the rings that hold its point. A list of all
// products, to be sorted, would take ten times the matrix.
#include <algorithm>
#include <cmath>

#include "parallel/cancel.h"
#include "thin_plate/matrix.h"

namespace fairing {
namespace {

using Column = EnergyRows::Column;

double product(const Column& a, const Column& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

class PlateAssembly {
 public:
  PlateAssembly(const GridLevel& grid, const Stencils& stencils, const Unknowns& unknowns,
                const VertexWeights& weights, Workers& workers)
      : grid_(grid),
        stencils_(stencils),
        weights_(weights),
        rings_(grid, unknowns, workers),
        places_(rings_),
        point_weight_(point_weights(grid)),
        number_(number_unknowns(grid, unknowns)) {
    for (std::size_t p = 0; p < number_.size(); ++p)
      if (number_[p] >= 0) system_.unknown_points.push_back(Index(p));
    find_large_rings();
  }

  AssembledSystem assemble() {
    const auto unknowns = Index(system_.unknown_points.size());
    const Index size = unknowns + Index(3 * large_.size());
    sum_.resize(std::size_t(size));
    seen_.assign(std::size_t(size), -1);
    SparseMatrix& matrix = system_.matrix;
    matrix.resize(size, size);
    Eigen::Index entries = 0;
    for (Index column = 0; column < size; ++column) {
      sum_up(column);
      entries += Eigen::Index(rows_.size());
    }
    matrix.reserve(entries);
    seen_.assign(std::size_t(size), -1);
    for (Index column = 0; column < size; ++column) {
      sum_up(column);
      std::sort(rows_.begin(), rows_.end());
      matrix.startVec(column);
      for (const Index row : rows_) matrix.insertBack(row, column) = sum_[std::size_t(row)];
    }
    matrix.finalize();
    system_.negative = size - unknowns;
    return std::move(system_);
  }

 private:
  // Fits about control vertices that hold too many unknowns.
  void find_large_rings() {
    for (Index v = 0; v < grid_.mesh().vertex_count(); ++v) {
      const RingTable::Ring& ring = rings_.about(v);
      const RingTable::Member* const members = rings_.members(ring);
      const auto held = std::count_if(members, members + ring.size, [](auto m) { return m >= 0; });
      if (stencils_.vertex_fit[std::size_t(v)] && std::size_t(held) > most_coupled)
        large_.push_back(v);
    }
  }

  // The first of a ring's auxiliary unknowns; -1: it is no large one.
  Index auxiliary_of(Index centre) const {
    const auto at = std::lower_bound(large_.begin(), large_.end(), centre);
    if (at == large_.end() || *at != centre) return -1;
    return Index(system_.unknown_points.size()) + 3 * Index(at - large_.begin());
  }

  // What a unit at a ring's member does to its three differences.
  Column column_of(Index centre, const EnergyRows& rows, std::size_t slot) const {
    const double scale =
        grid_.n() * std::sqrt(point_weight_.empty() ? 1.0 : point_weight_[std::size_t(centre)]);
    Column out = {};
    if (slot == 0)
      for (std::size_t k = 0; k < rows.size(); ++k)
        for (std::size_t c = 0; c < 3; ++c) out[c] -= scale * rows[rows.by_pairs(k)][c];
    else
      for (std::size_t c = 0; c < 3; ++c) out[c] = scale * rows[slot - 1][c];
    return out;
  }

  void add(Index row, double number) {
    double& sum = sum_[std::size_t(row)];
    if (std::exchange(seen_[std::size_t(row)], column_) == column_) {
      sum += number;
      return;
    }
    rows_.push_back(row);
    sum = number;
  }

  void sum_up(Index column) {
    column_ = column;
    rows_.clear();
    const auto unknowns = Index(system_.unknown_points.size());
    if (column >= unknowns) return sum_up_auxiliary(column - unknowns);
    const Index p = system_.unknown_points[std::size_t(column)];
    for (const RingPlaces::Place& place : places_.of(p)) add_ring(place.centre, place.slot);
    if (std::size_t(p) < weights_.size()) add(column, weights_[std::size_t(p)]);
  }

  void add_ring(Index centre, std::uint32_t slot) {
    const RingTable::Ring& ring = rings_.about(centre);
    const RingTable::Member* const members = rings_.members(ring);
    if (rings_.is_unknown(centre)) {
      const MembraneWeights membrane(grid_.mesh(), stencils_, ring.element);
      if (membrane.size() > 0)
        add(number_[std::size_t(centre)], slot == 0 ? membrane.total() : -membrane[slot - 1]);
    }
    const EnergyRows rows(grid_.mesh(), stencils_, ring.element);
    if (rows.size() == 0) return;
    const Column own = column_of(centre, rows, slot);
    if (const Index auxiliary = auxiliary_of(centre); auxiliary >= 0) {
      for (Index c = 0; c < 3; ++c) add(auxiliary + c, own[std::size_t(c)]);
      return;
    }
    for (std::size_t s = 0; s < ring.size; ++s)
      if (members[s] >= 0)
        add(number_[std::size_t(members[s])], product(column_of(centre, rows, s), own));
  }

  void sum_up_auxiliary(Index k) {
    const Index centre = large_[std::size_t(k / 3)];
    const RingTable::Ring& ring = rings_.about(centre);
    const RingTable::Member* const members = rings_.members(ring);
    const EnergyRows rows(grid_.mesh(), stencils_, ring.element);
    for (std::size_t s = 0; s < ring.size; ++s)
      if (members[s] >= 0)
        add(number_[std::size_t(members[s])], column_of(centre, rows, s)[std::size_t(k % 3)]);
    add(column_, -1);
  }

  const GridLevel& grid_;
  const Stencils& stencils_;
  const VertexWeights& weights_;
  const RingTable rings_;
  const RingPlaces places_;
  const Array<double> point_weight_;
  const std::vector<Index> number_;
  std::vector<Index> large_;  // centres, ascending
  AssembledSystem system_;

  // The column at hand: its rows in the order in which they were met, their sums, and for each row
  // the last column that met it.
  Index column_ = 0;
  std::vector<Index> rows_, seen_;
  std::vector<double> sum_;
};

}  // namespace

AssembledSystem assemble_thin_plate(const GridLevel& grid, const Stencils& stencils,
                                    const Unknowns& unknowns, const VertexWeights& weights,
                                    Workers& workers) {
  return PlateAssembly(grid, stencils, unknowns, weights, workers).assemble();
}

}  // namespace fairing
