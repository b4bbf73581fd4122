// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/matrix.h"

#include <cmath>

#include "base/simd.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// A row while it is summed, in double precision.
class RowSum {
 public:
  explicit RowSum(std::size_t columns) : marks_(thread_column_marks()) { marks_.fit(columns); }
  // Clears the marks that an exception has left, for the thread's next one.
  ~RowSum() { clear(); }
  RowSum(const RowSum&) = delete;
  RowSum& operator=(const RowSum&) = delete;

  void add(Index column, double number) {
    std::uint32_t& mark = marks_.mark[column];
    if (mark <= marks_.last) {
      column_.push_back(column);
      number_.push_back(0);
      mark = marks_.last + std::uint32_t(number_.size());
    }
    number_[mark - marks_.last - 1] += number;
  }
  void clear() {
    marks_.last += std::uint32_t(column_.size());
    column_.clear();
    number_.clear();
  }

  // In the order in which columns were first named.
  const std::vector<Index>& columns() const { return column_; }
  const std::vector<double>& numbers() const { return number_; }

 private:
  ColumnMarks& marks_;
  std::vector<Index> column_;
  std::vector<double> number_;
};

// Row p of K, from the rings that contain the point: those of its own ring's members.
void sum_row(const PlateDifferences& plate, Index p, RowSum& row) {
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

bool suits(const GridLevel& grid, const Stencils& stencils, bool on_surface) {
  if (!has_rows(grid.n(), grid.size(), PlateMatrix::most_pieces(on_surface))) return false;
  std::size_t products = 81 * grid.size();
  for (Index v = 0; v < grid.mesh().vertex_count(); ++v) {
    const std::size_t size = stencils.columns(v).size();
    products += size * size;
  }
  return worth_products(products, grid.size());
}

using Four = Packs<float, 16>;

template <class T, int Bytes>
struct RowsLoop {
  // Four sums a row, so that none waits for another. A pack has the three numbers of a point.
  DF_INLINE static void run(std::size_t rows, const std::uint32_t* end, const Index* column,
                            const float* number, const float* x, float* product) {
    Four::Pack p;
    std::size_t k = 0;
    for (std::size_t r = 0; r < rows; ++r, product += 3) {
      Four::Pack sum[4] = {};
      const auto add = [&](std::size_t m) __attribute__((always_inline)) {
        Four::load(x + 3 * std::size_t(column[k + m]), p);
        sum[m] += number[k + m] * p;
      };
      for (; k + 4 <= end[r]; k += 4)
#pragma GCC unroll 4
        for (std::size_t m = 0; m < 4; ++m) add(m);
      const std::size_t rest = end[r] - k;
      for (std::size_t m = 0; m < rest; ++m) add(m);
      k += rest;
      Four::store((sum[0] + sum[1]) + (sum[2] + sum[3]), product);
    }
  }
};

}  // namespace

std::unique_ptr<PlateMatrix> PlateMatrix::make(const GridLevel& grid, const Stencils& stencils,
                                               const Unknowns& unknowns, Workers& workers,
                                               const SurfaceRows* surface) {
  if (!suits(grid, stencils, surface != nullptr)) return nullptr;
  const PlateDifferences plate(grid, stencils, unknowns, workers, surface);
  return std::unique_ptr<PlateMatrix>(new PlateMatrix(plate, unknowns, workers));
}

PlateMatrix::PlateMatrix(const PlateDifferences& plate, const Unknowns& unknowns, Workers& workers)
    : moves_(unknowns.vertex) {
  const std::size_t points = plate.rings().points();
  chunk_.resize((points + chunk_rows - 1) / chunk_rows);
  workers.for_parts(chunk_.size(), 1, [&](std::size_t begin, std::size_t end) {
    RowSum row(points);
    Chunk chunk;
    for (std::size_t c = begin; c < end; ++c) {
      for (std::size_t p = c * chunk_rows; p < std::min(points, (c + 1) * chunk_rows); ++p) {
        if (plate.rings().is_unknown(Index(p))) sum_row(plate, Index(p), row);
        chunk.column.insert(chunk.column.end(), row.columns().begin(), row.columns().end());
        chunk.number.insert(chunk.number.end(), row.numbers().begin(), row.numbers().end());
        chunk.end.push_back(std::uint32_t(chunk.column.size()));
        row.clear();
      }
      chunk_[c] = chunk;  // a copy, so that its vectors have no spare capacity
      chunk.end.clear();
      chunk.column.clear();
      chunk.number.clear();
    }
  });
  std::size_t bytes = 0;
  for (const Chunk& chunk : chunk_)
    bytes += sizeof(std::uint32_t) * chunk.end.size() +
             (sizeof(Index) + sizeof(float)) * chunk.column.size();
  counted_.emplace(bytes);
}

void PlateMatrix::multiply(const Chunk& chunk, const float* x, float* product) {
  run_loop<RowsLoop, float>(chunk.end.size(), chunk.end.data(), chunk.column.data(),
                            chunk.number.data(), x, product);
}

template <class Visit>
void PlateMatrix::visit_numbers(Workers& workers, const Visit& visit) const {
  workers.for_each(chunk_.size(), 1, [&](std::size_t c) {
    const Chunk& chunk = chunk_[c];
    std::size_t k = 0;
    for (std::size_t r = 0; r < chunk.end.size(); ++r)
      for (; k < chunk.end[r]; ++k)
        visit(Index(c * chunk_rows + r), chunk.column[k], chunk.number[k]);
  });
}

void PlateMatrix::set_weights(const VertexWeights& weights) {
  weight_.clear();
  for (std::size_t v = 0; v < weights.size(); ++v)
    weight_.insert(weight_.end(), 3, v >= moves_.size() || moves_[v] ? float(weights[v]) : 0.0f);
}

void PlateMatrix::write_lines(const Array<float>& inverse_diagonal, LineBand& band,
                              Workers& workers) const {
  const auto offer = [&] {
    Array<float> root(inverse_diagonal.size());
    for_each_index(workers, root.size(),
                   [&](std::size_t p) { root[p] = std::sqrt(inverse_diagonal[p]); });
    visit_numbers(workers, [&](Index p, Index q, float number) {
      if (p != q && number != 0) band.offer(p, q, std::abs(number) * root[p] * root[q]);
    });
  };
  band.write(offer, [&] {
    visit_numbers(workers, [&](Index p, Index q, float number) { band.add(p, q, number); });
  });
}

Array<float> PlateMatrix::inverse_diagonal(Workers& workers) const {
  std::size_t points = 0;
  for (const Chunk& chunk : chunk_) points += chunk.end.size();
  Array<float> inverse(points, 0.0f);
  visit_numbers(workers, [&](Index p, Index q, float number) {
    if (p == q) inverse[p] = number;
  });
  for_each_index(workers, points, [&](std::size_t p) {
    const float diagonal = inverse[p] + (3 * p < weight_.size() ? weight_[3 * p] : 0.0f);
    inverse[p] = diagonal > 0 ? 1 / diagonal : 1.0f;
  });
  return inverse;
}

}  // namespace fairing
