// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/normal_matrix.h"

#include <algorithm>
#include <utility>

#include "base/simd.h"
#include "parallel/cancel.h"
#include "parallel/reductions.h"
#include "sparse/unknown_points.h"

namespace fairing {
namespace {

using Block = Packs<float, 16>;
constexpr std::size_t block_size = Block::size;

constexpr std::uint16_t none = 0xffff;
// Number of rows for a thread; a row has about as many blocks as a ring has points.
constexpr std::size_t grain = vector_grain / (block_size * most_slots);

// Whether all rings are so small that the size of their squares stays linear and 16 bits number the
// places in a row. A ring of rings has three points a slot, each at most in its own block.
bool are_small(const GridLevel& grid, const RingJacobian& rows) {
  std::size_t products = 81 * grid.size();
  for (Index v = 0; v < grid.mesh().vertex_count(); ++v) {
    const auto slots = std::size_t(rows.of(vertex_run(v)).slots);
    products += slots * slots;
    if (3 * slots * block_size >= none) return false;
  }
  return worth_products(products, grid.size());
}

// The columns of one row after another, grouped into blocks.
class RowBlocks {
 public:
  RowBlocks(std::size_t points, Array<Index>& block)
      : seen_(points, 0), place_(points), last_first_(Index(points - block_size)), block_(block) {}

  void begin_row() {
    ++row_;
    column_.clear();
  }
  void name(Index q) {
    if (std::exchange(seen_[std::size_t(q)], row_) != row_) column_.push_back(q);
  }
  // Call it after the last column; it computes the places.
  void finish_row() {
    std::sort(column_.begin(), column_.end());
    const std::size_t begin = block_.size();
    for (const Index q : column_) {
      if (block_.size() == begin || q >= block_.back() + Index(block_size))
        block_.push_back(std::min(q, last_first_));
      place_[std::size_t(q)] =
          std::uint16_t(block_size * (block_.size() - 1 - begin) + std::size_t(q - block_.back()));
    }
  }
  std::uint16_t place(Index q) const { return place_[std::size_t(q)]; }

 private:
  std::vector<std::uint32_t> seen_;   // the last row with this block
  std::vector<std::uint16_t> place_;  // its place in that row
  std::vector<Index> column_;
  Index last_first_;  // the first column of blocks that end with the last point
  std::uint32_t row_ = 0;
  Array<Index>& block_;
};

}  // namespace

bool NormalMatrix::suits(const RingJacobian& rows) {
  const GridLevel& grid = rows.grid();
  return has_rows(grid.n(), grid.size()) && grid.size() >= block_size && are_small(grid, rows);
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
  find_blocks(unknown);
  number_.resize(block_size * block_.size());
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

void NormalMatrix::find_blocks(const std::vector<Index>& unknown) {
  std::size_t targets = 0;
  for (const RingSlot& entry : ring_slot_) targets += jacobian_.size(entry.ring);
  target_.reserve(targets);
  block_.reserve(most_slots * unknown.size());
  RowBlocks row(unknown.size(), block_);
  for (std::size_t p = 0; p < unknown.size(); ++p) {
    stop_if_cancelled(p);
    block_begin_.push_back(block_.size());
    target_begin_.push_back(target_.size());
    const auto visit_members = [&](const auto& visit) {
      for (std::size_t k = ring_slot_begin_[p]; k < ring_slot_begin_[p + 1]; ++k) {
        const std::uint32_t r = ring_slot_[k].ring;
        for (std::uint32_t m = jacobian_.begin[r]; m < jacobian_.begin[r + 1]; ++m)
          visit(jacobian_.member[m], unknown[std::size_t(jacobian_.member[m])] >= 0);
      }
    };
    row.begin_row();
    visit_members([&](Index q, bool is_unknown) {
      if (is_unknown) row.name(q);
    });
    row.finish_row();
    visit_members(
        [&](Index q, bool is_unknown) { target_.push_back(is_unknown ? row.place(q) : none); });
  }
  block_begin_.push_back(block_.size());
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
      float* row = number_.data() + block_size * block_begin_[p];
      std::fill(row, number_.data() + block_size * block_begin_[p + 1], 0.0f);
      const Place* target = target_.data() + target_begin_[p];
      for (std::size_t k = ring_slot_begin_[p]; k < ring_slot_begin_[p + 1]; ++k) {
        const RingSlot entry = ring_slot_[k];
        const float* own = jacobian_.number.data() + 3 * (jacobian_.begin[entry.ring] + entry.slot);
        const float* other = jacobian_.number.data() + 3 * jacobian_.begin[entry.ring];
        const float* last = jacobian_.number.data() + 3 * jacobian_.begin[entry.ring + 1];
        for (; other < last; other += 3)
          if (const Place to = *target++; to != none)
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
      const Place* target = target_.data() + target_begin_[p];
      std::size_t k = ring_slot_begin_[p];
      const std::size_t last = ring_slot_begin_[p + 1];
      for (; k < last && ring_slot_[k].ring != p; ++k) target += jacobian_.size(ring_slot_[k].ring);
      if (k == last) continue;  // not an unknown
      float* row = number_.data() + block_size * block_begin_[p];
      for (int s = 1; s < own.slots; ++s) {
        const Place to = target[s];
        row[target[0]] += own.at(0, s, i);
        if (to != none) row[to] -= own.at(0, s, i);
      }
    }
  });
}

// Two independent sums, so that neither waits for the other.
void NormalMatrix::apply(const float* x, Workers& workers, float* y) const {
  workers.for_parts(grid_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      Block::Pack even = {}, odd = {}, of_x, numbers;
      const auto add = [&](std::size_t block, Block::Pack& sum) {
        Block::load(x + block_[block], of_x);
        Block::load(number_.data() + block_size * block, numbers);
        sum += numbers * of_x;
      };
      std::size_t k = block_begin_[p];
      const std::size_t last = block_begin_[p + 1];
      for (; k + 1 < last; k += 2) add(k, even), add(k + 1, odd);
      if (k < last) add(k, even);
      even += odd;
      y[p] = (even[0] + even[1]) + (even[2] + even[3]);
    }
  });
}

}  // namespace fairing
