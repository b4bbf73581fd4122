// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/normal_matrix.h"

#include <algorithm>
#include <utility>

#include "base/simd.h"
#include "parallel/cancel.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

using Block = Packs<float, 16>;
constexpr std::size_t block_size = Block::size;

constexpr std::uint16_t none = 0xffff;
// Number of rows for a thread; a row has about as many blocks as a ring has points.
constexpr std::size_t grain = vector_grain / (block_size * most_slots);

// Whether all rings are so small that the size of their squares stays linear and 16 bits number the
// places in a row. A ring of rings has three points a slot, each at most in its own block.
bool are_small(const GridLevel& grid, const RingRows& rows) {
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
    if (std::exchange(seen_[q], row_) != row_) column_.push_back(q);
  }
  // Call it after the last column; it computes the places.
  void finish_row() {
    std::sort(column_.begin(), column_.end());
    const std::size_t begin = block_.size();
    for (const Index q : column_) {
      if (block_.size() == begin || q >= block_.back() + Index(block_size))
        block_.push_back(std::min(q, last_first_));
      place_[q] =
          std::uint16_t(block_size * (block_.size() - 1 - begin) + std::size_t(q - block_.back()));
    }
  }
  std::uint16_t place(Index q) const { return place_[q]; }

 private:
  std::vector<std::uint32_t> seen_;   // the last row with this block
  std::vector<std::uint16_t> place_;  // its place in that row
  std::vector<Index> column_;
  Index last_first_;  // the first column of blocks that end with the last point
  std::uint32_t row_ = 0;
  Array<Index>& block_;
};

}  // namespace

bool NormalMatrix::suits(const RingRows& rows) {
  const GridLevel& grid = rows.grid();
  return has_rows(grid.n(), grid.size(), most_pieces) && grid.size() >= block_size &&
         are_small(grid, rows);
}

NormalMatrix::NormalMatrix(const RingRows& rows, const Unknowns& unknowns, Workers& workers)
    : grid_(rows.grid()), rings_(grid_, unknowns, workers), places_(rings_) {
  const RingTable::Ring& last = rings_.about(Index(grid_.size() - 1));
  jacobian_.resize(3 * (last.member + last.size));
  find_blocks();
  number_.resize(block_size * block_.size());
}

void NormalMatrix::find_blocks() {
  const std::size_t points = grid_.size();
  const auto visit_members = [&](std::size_t p, const auto& visit) {
    for (const RingPlaces::Place& place : places_.of(Index(p))) {
      const RingTable::Ring& ring = rings_.about(place.centre);
      for (std::size_t s = 0; s < ring.size; ++s) visit(rings_.members(ring)[s]);
    }
  };
  std::size_t targets = 0;
  for (std::size_t p = 0; p < points; ++p)
    for (const RingPlaces::Place& place : places_.of(Index(p)))
      targets += rings_.about(place.centre).size;
  target_.reserve(targets);
  block_.reserve(most_slots * points);
  RowBlocks row(points, block_);
  for (const std::size_t p : Cancellable(points)) {
    block_begin_.push_back(block_.size());
    target_begin_.push_back(target_.size());
    row.begin_row();
    visit_members(p, [&](RingTable::Member q) {
      if (q >= 0) row.name(q);
    });
    row.finish_row();
    visit_members(p, [&](RingTable::Member q) { target_.push_back(q >= 0 ? row.place(q) : none); });
  }
  block_begin_.push_back(block_.size());
  target_begin_.push_back(target_.size());
}

void NormalMatrix::update(const RingRows& rows, Workers& workers, const RingRows* tension) {
  for_each_run(grid_, workers, [&](const Run& run) {
    const RowRun<const float> own = rows.of(run);
    float* to = jacobian_.data() + 3 * rings_.about(Index(run.first)).member;
    for (std::size_t i = 0; i < run.count; ++i)
      for (int s = 0; s < own.slots; ++s)
        for (int c = 0; c < 3; ++c) *to++ = own.at(c, s, i);
  });
  workers.for_each(grid_.size(), grain, [&](std::size_t p) {
    float* row = number_.data() + block_size * block_begin_[p];
    std::fill(row, number_.data() + block_size * block_begin_[p + 1], 0.0f);
    const Place* target = target_.data() + target_begin_[p];
    for (const RingPlaces::Place& place : places_.of(Index(p))) {
      const RingTable::Ring& ring = rings_.about(place.centre);
      const float* other = jacobian_.data() + 3 * ring.member;
      const float *own = other + 3 * place.slot, *last = other + 3 * ring.size;
      for (; other < last; other += 3)
        if (const Place to = *target++; to != none)
          row[to] += own[0] * other[0] + own[1] * other[1] + own[2] * other[2];
    }
  });
  if (tension) add_tension(*tension, workers);
}

// A point's row of the Laplacian is over its own ring.
void NormalMatrix::add_tension(const RingRows& weights, Workers& workers) {
  for_each_run(grid_, workers, [&](const Run& run) {
    const RowRun<const float> own = weights.of(run);
    for (std::size_t p = run.first; p < run.first + run.count; ++p) {
      if (!rings_.is_unknown(Index(p))) continue;
      const Place* target = target_.data() + target_begin_[p];
      for (const RingPlaces::Place& place : places_.of(Index(p))) {
        if (place.centre == Index(p)) break;
        target += rings_.about(place.centre).size;
      }
      float* row = number_.data() + block_size * block_begin_[p];
      for (int s = 1; s < own.slots; ++s) {
        const float weight = own.at(0, s, p - run.first);
        row[target[0]] += weight;
        if (target[s] != none) row[target[s]] -= weight;
      }
    }
  });
}

// Two independent sums, so that neither waits for the other.
void NormalMatrix::apply(const float* x, Workers& workers, float* y) const {
  workers.for_each(grid_.size(), grain, [&](std::size_t p) {
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
  });
}

}  // namespace fairing
