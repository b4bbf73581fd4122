// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/normal_matrix.h"

#include <algorithm>

#include "parallel/cancel.h"
#include "parallel/reductions.h"
#include "sparse/unknown_points.h"

namespace fairing {
namespace {

// Room that is reserved a row: inside a quad, the ring's rings.
constexpr std::size_t regular_columns = 25;
constexpr std::uint16_t none = 0xffff;
constexpr std::size_t grain = vector_grain / regular_columns;  // rows worth a thread
// Partial sums of a row's products, none of which waits for another. Regular rows have 19 or 25
// numbers.
constexpr std::size_t sums = 6;

// Whether no rings are so large that their squares are not linear.
bool is_linear(const RingJacobian& rows) {
  const GridLevel& grid = rows.grid();
  std::size_t products = 81 * grid.size();
  for (Index v = 0; v < grid.mesh().vertex_count(); ++v) {
    const auto slots = std::size_t(rows.of(vertex_run(v)).slots);
    products += slots * slots;
  }
  return worth_products(products, grid.size());
}

// Points in the order in which a row first names them, row after row.
class NamedPoints {
 public:
  NamedPoints(std::size_t points, Array<Index>& named) : seen_(points, 0), named_(named) {}

  // Where its points begin.
  std::size_t begin_row() { return first_ = named_.size(); }
  // A point's place in the row.
  std::uint16_t place(Index q) {
    std::size_t& at = seen_[std::size_t(q)];
    if (at <= first_) {
      named_.push_back(q);
      at = named_.size();
    }
    return std::uint16_t(at - 1 - first_);
  }

 private:
  std::vector<std::size_t> seen_;  // 1 + the place among all
  Array<Index>& named_;
  std::size_t first_ = 0;
};

}  // namespace

bool NormalMatrix::suits(const RingJacobian& rows) {
  return rows.grid().n() <= most_pieces_of_matrix && is_linear(rows);
}

NormalMatrix::NormalMatrix(const RingJacobian& rows, const Unknowns& unknowns)
    : grid_(rows.grid()) {
  const float* origin = rows.data();
  visit_rows(rows, [&](Index, const RowRun<const float>& run, std::size_t i,
                       const std::vector<Index>& points) {
    stop_if_cancelled(ring_.size());
    ring_.push_back({std::size_t(&run.at(0, 0, i) - origin), std::uint32_t(run.count)});
    jacobian_.begin.push_back(std::uint32_t(jacobian_.member.size()));
    jacobian_.member.insert(jacobian_.member.end(), points.begin(), points.end());
  });
  jacobian_.begin.push_back(std::uint32_t(jacobian_.member.size()));
  jacobian_.number.resize(3 * jacobian_.member.size());
  const std::vector<Index> unknown = number_unknowns(grid_, unknowns);
  find_ring_slots(unknown);
  find_columns(unknown);
  number_.resize(column_.size());
}

void NormalMatrix::find_ring_slots(const std::vector<Index>& unknown) {
  ring_slot_begin_.assign(unknown.size() + 1, 0);
  for (std::size_t m = 0; m < jacobian_.member.size(); ++m) {
    stop_if_cancelled(m);
    if (const auto q = std::size_t(jacobian_.member[m]); unknown[q] >= 0) ++ring_slot_begin_[q + 1];
  }
  for (std::size_t p = 0; p < unknown.size(); ++p) ring_slot_begin_[p + 1] += ring_slot_begin_[p];
  ring_slot_.resize(ring_slot_begin_.back());
  Array<std::size_t> next(ring_slot_begin_.begin(), ring_slot_begin_.end() - 1);
  for (std::uint32_t r = 0; r < unknown.size(); ++r) {
    stop_if_cancelled(r);
    for (std::uint32_t k = jacobian_.begin[r]; k < jacobian_.begin[r + 1]; ++k) {
      const auto q = std::size_t(jacobian_.member[k]);
      if (unknown[q] >= 0) ring_slot_[next[q]++] = {r, k - jacobian_.begin[r]};
    }
  }
}

void NormalMatrix::find_columns(const std::vector<Index>& unknown) {
  std::size_t targets = 0;
  for (const RingSlot& entry : ring_slot_) targets += jacobian_.size(entry.ring);
  target_.reserve(targets);
  column_.reserve(regular_columns * unknown.size());
  NamedPoints points(unknown.size(), column_);
  for (std::size_t p = 0; p < unknown.size(); ++p) {
    stop_if_cancelled(p);
    column_begin_.push_back(points.begin_row());
    target_begin_.push_back(target_.size());
    for (std::size_t k = ring_slot_begin_[p]; k < ring_slot_begin_[p + 1]; ++k) {
      const std::uint32_t r = ring_slot_[k].ring;
      for (std::uint32_t m = jacobian_.begin[r]; m < jacobian_.begin[r + 1]; ++m) {
        const Index q = jacobian_.member[m];
        target_.push_back(unknown[std::size_t(q)] < 0 ? none : points.place(q));
      }
    }
  }
  column_begin_.push_back(column_.size());
  target_begin_.push_back(target_.size());
}

void NormalMatrix::update(const RingJacobian& rows, Workers& workers, const RingJacobian* tension) {
  const float* origin = rows.data();
  const std::size_t points = grid_.size();
  workers.for_parts(points, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Ring& ring = ring_[p];
      const std::size_t slots = jacobian_.size(p);
      float* to = jacobian_.number.data() + 3 * jacobian_.begin[p];
      for (std::size_t s = 0; s < slots; ++s)
        for (std::size_t c = 0; c < 3; ++c)
          to[3 * s + c] = origin[ring.first + (c * slots + s) * ring.stride];
    }
  });
  workers.for_parts(points, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      float* row = number_.data() + column_begin_[p];
      std::fill(row, number_.data() + column_begin_[p + 1], 0.0f);
      const LocalColumn* target = target_.data() + target_begin_[p];
      for (std::size_t k = ring_slot_begin_[p]; k < ring_slot_begin_[p + 1]; ++k) {
        const RingSlot entry = ring_slot_[k];
        const float* own = jacobian_.number.data() + 3 * (jacobian_.begin[entry.ring] + entry.slot);
        const float* other = jacobian_.number.data() + 3 * jacobian_.begin[entry.ring];
        const float* last = jacobian_.number.data() + 3 * jacobian_.begin[entry.ring + 1];
        for (; other < last; other += 3)
          if (const LocalColumn to = *target++; to != none)
            row[to] += own[0] * other[0] + own[1] * other[1] + own[2] * other[2];
      }
    }
  });
  if (tension) add_tension(*tension, workers);
}

// A point's row of the Laplacian is over its own ring.
void NormalMatrix::add_tension(const RingJacobian& weights, Workers& workers) {
  for_each_run(grid_, workers, [&](const Run& run) {
    const RowRun<const float> own = weights.of(run);
    for (std::size_t i = 0; i < run.count; ++i) {
      const std::size_t p = run.first + i;
      const LocalColumn* target = target_.data() + target_begin_[p];
      std::size_t k = ring_slot_begin_[p];
      const std::size_t last = ring_slot_begin_[p + 1];
      for (; k < last && ring_slot_[k].ring != p; ++k) target += jacobian_.size(ring_slot_[k].ring);
      if (k == last) continue;  // no unknown
      float* row = number_.data() + column_begin_[p];
      for (int s = 1; s < own.slots; ++s) {
        const LocalColumn to = target[s];
        row[target[0]] += own.at(0, s, i);
        if (to != none) row[to] -= own.at(0, s, i);
      }
    }
  });
}

void NormalMatrix::apply(const float* x, Workers& workers, float* y) const {
  workers.for_parts(grid_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      float sum[sums] = {};
      const float* number = number_.data() + column_begin_[p];
      const Index* column = column_.data() + column_begin_[p];
      std::size_t left = column_begin_[p + 1] - column_begin_[p];
      for (; left >= sums; left -= sums, number += sums, column += sums)
        for (std::size_t m = 0; m < sums; ++m) sum[m] += number[m] * x[column[m]];
      for (std::size_t m = 0; m < left; ++m) sum[m] += number[m] * x[column[m]];
      y[p] = ((sum[0] + sum[1]) + (sum[2] + sum[3])) + (sum[4] + sum[5]);
    }
  });
}

}  // namespace fairing
