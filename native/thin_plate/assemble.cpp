// SPDX-License-Identifier: GPL-3.0-or-later
// assemble_thin_plate(): column by column, each from the rings that hold its point. A list of all
// products, to be sorted, would take ten times the matrix.
#include <algorithm>

#include "parallel/cancel.h"
#include "thin_plate/differences.h"
#include "thin_plate/matrix.h"

namespace fairing {
namespace {

using Column = PlateDifferences::Column;

double product(const Column& a, const Column& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

class PlateAssembly {
 public:
  PlateAssembly(const GridLevel& grid, const Stencils& stencils, const Unknowns& unknowns,
                const VertexWeights& weights, Workers& workers, const SurfaceDifferences* surface)
      : plate_(grid, stencils, unknowns, workers, surface),
        weights_(weights),
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
    for (Index v = 0; v < plate_.grid().mesh().vertex_count(); ++v) {
      const RingTable::Ring& ring = plate_.rings().about(v);
      const RingTable::Member* const members = plate_.rings().members(ring);
      const auto held = std::count_if(members, members + ring.size, [](auto m) { return m >= 0; });
      if (std::size_t(held) > most_coupled && plate_.rows(v).size() > 0) large_.push_back(v);
    }
  }

  // The first of a ring's auxiliary unknowns; -1: it is no large one.
  Index auxiliary_of(Index centre) const {
    const auto at = std::lower_bound(large_.begin(), large_.end(), centre);
    if (at == large_.end() || *at != centre) return -1;
    return Index(system_.unknown_points.size()) + 3 * Index(at - large_.begin());
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
    for (const RingPlaces::Place& place : plate_.places().of(p)) add_ring(place.centre, place.slot);
    const double held = std::size_t(p) < weights_.size() ? weights_[std::size_t(p)] : 0.0;
    if (const double sum = held + plate_.pull(p); sum != 0) add(column, sum);
  }

  void add_ring(Index centre, std::uint32_t slot) {
    const RingTable::Ring& ring = plate_.rings().about(centre);
    const RingTable::Member* const members = plate_.rings().members(ring);
    if (plate_.rings().is_unknown(centre)) {
      const MembraneWeights membrane = plate_.membrane(centre);
      if (membrane.size() > 0)
        add(number_[std::size_t(centre)], slot == 0 ? membrane.total() : -membrane[slot - 1]);
    }
    const EnergyRows rows = plate_.rows(centre);
    if (rows.size() == 0) return;
    const Column own = plate_.column(centre, rows, slot);
    if (const Index auxiliary = auxiliary_of(centre); auxiliary >= 0) {
      for (Index c = 0; c < 3; ++c) add(auxiliary + c, own[std::size_t(c)]);
      return;
    }
    for (std::size_t s = 0; s < ring.size; ++s)
      if (members[s] >= 0)
        add(number_[std::size_t(members[s])], product(plate_.column(centre, rows, s), own));
  }

  void sum_up_auxiliary(Index k) {
    const Index centre = large_[std::size_t(k / 3)];
    const RingTable::Ring& ring = plate_.rings().about(centre);
    const RingTable::Member* const members = plate_.rings().members(ring);
    const EnergyRows rows = plate_.rows(centre);
    for (std::size_t s = 0; s < ring.size; ++s)
      if (members[s] >= 0)
        add(number_[std::size_t(members[s])], plate_.column(centre, rows, s)[std::size_t(k % 3)]);
    add(column_, -1);
  }

  const PlateDifferences plate_;
  const VertexWeights& weights_;
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
                                    Workers& workers, const SurfaceDifferences* surface) {
  return PlateAssembly(grid, stencils, unknowns, weights, workers, surface).assemble();
}

}  // namespace fairing
