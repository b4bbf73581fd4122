// SPDX-License-Identifier: GPL-3.0-or-later
// K = R^T D R on a level, summed row by row; and as a matrix in single precision, for levels whose
// faces have few points: there, passes over the rows R cost more than an index for each number.
//
// `Rows` are R over the one-rings: rings(), a RingTable; has_rows(ring); column(ring, slot), the
// three numbers of a member; weight(centre), that of D; and add_own(p, sum), which adds whatever
// K's row of the unknown p has besides.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "sparse/ring_table.h"

namespace fairing {

// A row of a matrix while it is summed.
class RowSum {
 public:
  using Entry = std::pair<Index, double>;  // column, number

  explicit RowSum(std::size_t columns) : marks_(thread_column_marks()) { marks_.fit(columns); }
  // Clears the marks that an exception has left, for the thread's next one.
  ~RowSum() { clear(); }
  RowSum(const RowSum&) = delete;
  RowSum& operator=(const RowSum&) = delete;

  void add(Index column, double number) {
    std::uint32_t& mark = marks_.mark[column];
    if (mark <= marks_.last) {
      entries_.emplace_back(column, 0.0);
      mark = marks_.last + std::uint32_t(entries_.size());
    }
    entries_[mark - marks_.last - 1].second += number;
  }
  void clear() {
    marks_.last += std::uint32_t(entries_.size());
    entries_.clear();
  }
  // In the order in which columns were first named.
  const std::vector<Entry>& entries() const { return entries_; }
  // By column; then only clear() may follow.
  const std::vector<Entry>& sorted() {
    std::sort(entries_.begin(), entries_.end());
    return entries_;
  }

 private:
  ColumnMarks& marks_;
  std::vector<Entry> entries_;
};

// Adds row p of K, from the rings that contain the point: those of its own ring's members.
template <class Rows>
void sum_row(const Rows& rows, Index p, RowSum& sum) {
  const RingTable& rings = rows.rings();
  const RingTable::Ring& own = rings.about(p);
  for (std::size_t k = 0; k < own.size; ++k) {
    const Index centre = RingTable::id_of(rings.members(own)[k]);
    const RingTable::Ring& ring = rings.about(centre);
    const std::size_t slot = rows.has_rows(ring) ? rings.slot(ring, p) : ring.size;
    if (slot == ring.size) continue;
    const RingTable::Member* members = rings.members(ring);
    const auto& at = rows.column(ring, slot);
    const double weight = rows.weight(centre);
    for (std::size_t m = 0; m < ring.size; ++m) {
      if (members[m] < 0) continue;
      const auto& to = rows.column(ring, m);
      sum.add(members[m], weight * (double(at[0]) * double(to[0]) + double(at[1]) * double(to[1]) +
                                    double(at[2]) * double(to[2])));
    }
  }
  rows.add_own(p, sum);
}

// Calls visit(p, q, number) for all of K's numbers in the rows of unknowns p with wants(p), in
// parallel; a row is visited by one thread.
template <class Rows, class Wants, class Visit>
void visit_numbers(const Rows& rows, Workers& workers, const Wants& wants, const Visit& visit) {
  const std::size_t points = rows.rings().points();
  workers.for_parts(points, vertex_grain, [&](std::size_t begin, std::size_t end) {
    RowSum sum(points);
    for (std::size_t p = begin; p < end; ++p) {
      if (!rows.rings().is_unknown(Index(p)) || !wants(Index(p))) continue;
      sum_row(rows, Index(p), sum);
      for (const auto& [q, number] : sum.entries()) visit(Index(p), q, float(number));
      sum.clear();
    }
  });
}

// Whether a matrix may be faster than passes on a level of n subdivisions and so many points: where
// faces are large, it costs more memory and time to read it.
constexpr bool has_matrix(int n, std::size_t points, int most_pieces) {
  return n > 1 && n <= most_pieces && points <= std::size_t(1) << 22;
}

// C: numbers a point of the vectors, 1 or 3. Most columns of a row are adjacent, as the points of a
// run are. So with one number a point a row is stored in blocks of four numbers, zero where there is
// no entry, with the first of their columns: at eight pieces an edge 18 columns in 7 blocks.
template <int C>
class RingMatrix {
 public:
  // Whether has_matrix(), and rings are so small that their squares are linear in the number of
  // points.
  static bool suits(const GridLevel& grid, int most_pieces);

  // Throws if the run is cancelled.
  template <class Rows>
  RingMatrix(const Rows& rows, Workers& workers) {
    const std::size_t points = rows.rings().points();
    chunk_.resize((points + chunk_rows - 1) / chunk_rows);
    workers.for_parts(chunk_.size(), 1, [&](std::size_t begin, std::size_t end) {
      RowSum sum(points);
      Chunk chunk;
      for (std::size_t c = begin; c < end; ++c) {
        for (std::size_t p = c * chunk_rows; p < std::min(points, (c + 1) * chunk_rows); ++p) {
          if (rows.rings().is_unknown(Index(p))) sum_row(rows, Index(p), sum);
          append(sum, Index(points - width), chunk);
          sum.clear();
        }
        chunk_[c] = chunk;  // a copy, so that its vectors have no spare capacity
        chunk.end.clear();
        chunk.column.clear();
        chunk.number.clear();
      }
    });
    count_bytes();
  }

  // y <- K x; zero off the unknowns. All numbers of x must be finite; x has `vector_room` extra
  // ones.
  void apply(const float* x, Workers& workers, float* y) const;

  // As visit_numbers() of the rows; zeros may be among the numbers.
  template <class Wants, class Visit>
  void visit_numbers(Workers& workers, const Wants& wants, const Visit& visit) const {
    workers.for_each(chunk_.size(), 1, [&](std::size_t c) {
      const Chunk& chunk = chunk_[c];
      std::size_t k = 0;
      for (std::size_t r = 0; r < chunk.end.size(); k = chunk.end[r++]) {
        const auto p = Index(c * chunk_rows + r);
        if (!wants(p)) continue;
        for (; k < chunk.end[r]; ++k)
          for (std::size_t m = 0; m < width; ++m)
            visit(p, chunk.column[k] + Index(m), chunk.number[width * k + m]);
      }
    });
  }

 private:
  static constexpr std::size_t width = C == 1 ? 4 : 1;  // of a block
  // Rows that one thread multiplies.
  static constexpr std::size_t chunk_rows = 256;
  struct Chunk {
    std::vector<std::uint32_t> end;  // of each row's blocks; a point that is no unknown has none
    std::vector<Index> column;       // the first of each block
    std::vector<float> number;
  };

  // `last`: the first column of blocks that end with the last point.
  static void append(RowSum& sum, Index last, Chunk& chunk);
  void count_bytes();

  Array<Chunk> chunk_;
  std::optional<CountedBytes> counted_;
};

}  // namespace fairing
