// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/assembly.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/ring.h"
#include "grid/runs.h"

namespace fairing {
namespace {

// A sparse column while it is summed.
class Column {
 public:
  explicit Column(Eigen::Index rows) : value_(std::size_t(rows)), used_(std::size_t(rows)) {}

  void clear() {
    for (const Index r : rows_) used_[r] = 0;
    rows_.clear();
  }

  void add(const SparseMatrix& matrix, Index column, double factor) {
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry) {
      const auto r = std::size_t(entry.row());
      if (!used_[r]) {
        used_[r] = 1;
        value_[r] = entry.value() * factor;
        rows_.push_back(Index(r));
      } else {
        value_[r] += entry.value() * factor;
      }
    }
  }

  void sort() { std::sort(rows_.begin(), rows_.end()); }
  const std::vector<Index>& rows() const { return rows_; }
  double operator[](Index row) const { return value_[row]; }

 private:
  std::vector<double> value_;
  std::vector<std::uint8_t> used_;
  std::vector<Index> rows_;
};

// Space for one more column: when needed, for all remaining ones at the mean size so far.
void make_room(SparseMatrix& matrix, Eigen::Index column, std::size_t entries) {
  auto& numbers = matrix.data();
  const auto now = std::size_t(numbers.size());
  if (now + entries <= std::size_t(numbers.allocatedSize())) return;
  const double mean = double(now + entries) / double(column + 1);
  numbers.reserve(Eigen::Index(entries + std::size_t(mean * double(matrix.cols() - column - 1))));
}

// Control vertices with more than most_coupled unknowns in the ring, ascending. `apart`: no
// neighbours.
std::vector<Index> large_rings(const GridLevel& grid, const std::vector<Index>& number,
                               bool apart) {
  std::vector<Index> large;
  for (Index v = 0; v < grid.mesh().vertex_count(); ++v) {
    std::size_t held = number[v] >= 0;
    bool alone = true;
    visit_ring(grid, v, [&](Index q, std::size_t) {
      held += number[q] >= 0;
      alone &= !apart || !std::binary_search(large.begin(), large.end(), q);
    });
    if (held > most_coupled && alone) large.push_back(v);
  }
  return large;
}

// Adds the auxiliary unknowns of the rows u, then those of w, to K.
void border(const SparseMatrix& u, const SparseMatrix& w, AssembledSystem& system) {
  Triplets entries;
  auto first = Index(system.unknown_points.size());
  for (const auto& [side, diagonal] : {std::pair(&u, -1.0), std::pair(&w, 1.0)}) {
    for (Index c = 0; c < Index(side->cols()); ++c)
      for (SparseMatrix::InnerIterator entry(*side, c); entry; ++entry) {
        entries.emplace_back(first + Index(entry.row()), c, entry.value());
        entries.emplace_back(c, first + Index(entry.row()), entry.value());
      }
    for (Index r = 0; r < Index(side->rows()); ++r)
      entries.emplace_back(first + r, first + r, diagonal);
    first += Index(side->rows());
  }
  add_entries(entries, system);
  system.negative = Index(u.rows());
}

// The numbers of a ring's unknowns, ascending, each once.
class RingColumns {
 public:
  struct Entry {
    Index column;
    std::array<double, 3> number;
  };

  const std::vector<Entry>& read(const std::vector<Index>& number, const std::vector<Index>& ring,
                                 const std::vector<double>& numbers) {
    out_.clear();
    for (std::size_t s = 0; s < ring.size(); ++s)
      if (const Index column = number[ring[s]]; column >= 0)
        out_.push_back({column, {numbers[3 * s], numbers[3 * s + 1], numbers[3 * s + 2]}});
    std::stable_sort(out_.begin(), out_.end(),
                     [](const Entry& a, const Entry& b) { return a.column < b.column; });
    std::size_t last = 0;
    for (std::size_t s = 1; s < out_.size(); ++s) {
      if (out_[s].column != out_[last].column)
        out_[++last] = out_[s];
      else
        for (std::size_t c = 0; c < 3; ++c) out_[last].number[c] += out_[s].number[c];
    }
    out_.resize(std::min(out_.size(), last + 1));
    return out_;
  }

 private:
  std::vector<Entry> out_;
};

// J^T S J from `rows`, which is J^T, a column at a time, since S J has several times the numbers of
// J. `middle`: S, or null for J^T J. Sums have the order of Eigen's products. on_turned(column, row,
// entry) receives the entries of S J, column by column.
template <class OnTurned>
SparseMatrix congruence(const SparseMatrix& rows, const SparseMatrix* middle,
                        const OnTurned& on_turned) {
  const SparseMatrix jacobian = rows.transpose();
  const MatrixBytes held(jacobian);
  SparseMatrix out(jacobian.cols(), jacobian.cols());
  Column turned(middle ? jacobian.rows() : 0), product(jacobian.cols());
  for (Index c = 0; c < Index(jacobian.cols()); ++c) {
    product.clear();
    if (middle) {
      turned.clear();
      for (SparseMatrix::InnerIterator entry(jacobian, c); entry; ++entry)
        turned.add(*middle, Index(entry.row()), entry.value());
      turned.sort();
      for (const Index r : turned.rows()) {
        product.add(rows, r, turned[r]);
        on_turned(c, r, turned[r]);
      }
    } else {
      for (SparseMatrix::InnerIterator entry(jacobian, c); entry; ++entry)
        product.add(rows, Index(entry.row()), entry.value());
    }
    product.sort();
    make_room(out, c, product.rows().size());
    out.startVec(c);
    for (const Index r : product.rows()) out.insertBackByOuterInner(c, r) = product[r];
  }
  out.finalize();
  out.data().squeeze();
  const MatrixBytes out_held(out);
  return out;
}

}  // namespace

// The three rows J_a of a control vertex with a large ring are left out of J and become auxiliary
// unknowns: u = J_a if there is no S. Else, with the diagonal d > 0 of S at the vertex and the
// neighbours' contribution h = S_ar J_r, the energy is
//
//   d |J_a x|^2 + 2 J_a x . h x = |u x|^2 - |w x|^2,   u = (d J_a + h) / sqrt d,   w = h / sqrt d
AssembledSystem assemble_square(const GridLevel& grid, const std::vector<Index>& number,
                                const SparseMatrix* middle,
                                const std::function<void(const VisitRows&)>& visit) {
  AssembledSystem system;
  for (std::size_t p = 0; p < number.size(); ++p)
    if (number[p] >= 0) system.unknown_points.push_back(Index(p));
  const std::vector<Index> large = large_rings(grid, number, middle != nullptr);
  const auto place_of = [&](Index p) {  // -1: its ring is not large
    const auto at = std::lower_bound(large.begin(), large.end(), p);
    return at != large.end() && *at == p ? Index(at - large.begin()) : -1;
  };
  const auto root_of = [&](Index p) { return middle ? std::sqrt(middle->coeff(3 * p, 3 * p)) : 1; };
  const auto unknowns = Index(system.unknown_points.size()), apart = Index(3 * large.size());
  SparseMatrix rows(unknowns + (middle ? 2 : 1) * apart, Eigen::Index(3 * grid.size()));
  rows.reserve(Eigen::Index(3 * most_slots * grid.size()));
  Triplets of_u, of_w;
  RingColumns columns;
  Index p = 0;
  visit([&](const std::vector<Index>& ring, const std::vector<double>& numbers) {
    const auto& own = columns.read(number, ring, numbers);
    const Index k = place_of(p);
    for (Index c = 0; c < 3; ++c) {
      rows.startVec(3 * p + c);
      for (const auto& [column, entry] : own)
        if (k < 0)
          rows.insertBack(column, 3 * p + c) = entry[c];
        else
          of_u.emplace_back(3 * k + c, column, root_of(p) * entry[c]);
    }
    ++p;
  });
  rows.finalize();
  const MatrixBytes held(rows);
  const auto on_turned = [&](Index c, Index row, double entry) {
    const Index k = place_of(row / 3);
    const double root = k < 0 ? 0 : root_of(row / 3);
    if (!(root > 0)) return;
    of_u.emplace_back(3 * k + row % 3, c, entry / root);
    of_w.emplace_back(3 * k + row % 3, c, entry / root);
  };
  congruence(rows, middle, on_turned).swap(system.matrix);
  if (apart == 0) return system;
  const MatrixBytes matrix_held(system.matrix);
  SparseMatrix u(apart, unknowns), w(middle ? apart : 0, unknowns);
  u.setFromTriplets(of_u.begin(), of_u.end());
  w.setFromTriplets(of_w.begin(), of_w.end());
  border(u, w, system);
  return system;
}

void add_entries(const Triplets& entries, AssembledSystem& system) {
  SparseMatrix more(system.matrix.rows(), system.matrix.cols());
  more.setFromTriplets(entries.begin(), entries.end());
  system.matrix += more;
}

}  // namespace fairing
