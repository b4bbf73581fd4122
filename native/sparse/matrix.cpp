// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/matrix.h"

#include <utility>

#include "base/simd.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Four = Packs<float, 16>;

template <class T, int Bytes>
struct RowsLoop {
  // `local`: room for four numbers a column of the chunk
  DF_INLINE static void run(const RowChunk* chunk, const float* x, float* local, float* product) {
    Four::Pack p;
    for (std::size_t k = 0; k < chunk->column.size(); ++k) {
      Four::load(x + 3 * std::size_t(chunk->column[k]), p);
      Four::store(p, local + 4 * k);
    }
    const RowChunk::LocalColumn* column = chunk->local_column.data();
    for (const RowChunk::Row& row : chunk->row) {
      const RowChunk::LocalColumn* const end = chunk->local_column.data() + row.end;
      const float* number = chunk->number.data() + row.number;
      Four::Pack sum[row_block] = {};
      for (; column < end; column += row_block, number += row_block)
#pragma GCC unroll 4
        for (std::size_t m = 0; m < row_block; ++m) {
          Four::load(local + 4 * std::size_t(column[m]), p);
          sum[m] += number[m] * p;
        }
      Four::store((sum[0] + sum[1]) + (sum[2] + sum[3]), product);
      product += 3;
    }
  }
};

}  // namespace

void chunk_product(const RowChunk& chunk, const float* x, float* product) {
  float* const local = room_in(thread_scratch<float>().columns, 4 * chunk.column.size());
  run_loop<RowsLoop, float>(&chunk, x, local, product);
}

bool RowBuilder::repeat(Numbers& numbers, std::span<const Index> columns) {
  for (const Index column : columns) {
    if (names(column)) {
      in_row_.last += std::uint32_t(column_.size());
      column_.clear();
      return false;
    }
    column_.push_back(std::uint32_t(column));
    in_row_.mark[column] = in_row_.last + std::uint32_t(column_.size());
  }
  repeated_ = &numbers;
  return true;
}

void RowBuilder::finish() {
  std::vector<RowChunk::LocalColumn>& local = chunk_.local_column;
  for (const std::uint32_t column : column_) local.push_back(local_column(column));
  for (std::size_t k = column_.size(); k % row_block != 0; ++k) local.push_back(local.back());
  chunk_.row.push_back({std::uint32_t(local.size()), first_number()});
  in_row_.last += std::uint32_t(column_.size());
  sum_.clear();
  column_.clear();
  repeated_ = nullptr;
}

std::uint32_t RowBuilder::first_number() {
  if (repeated_ && repeated_->chunk_ == chunks_) return repeated_->first_;
  if (repeated_)
    number_.assign(repeated_->number_.begin(), repeated_->number_.end());
  else
    number_.assign(sum_.begin(), sum_.end());
  while (number_.size() % row_block != 0) number_.push_back(0);
  const std::uint32_t first = keep_numbers();
  if (repeated_) repeated_->chunk_ = chunks_, repeated_->first_ = first;
  return first;
}

RowChunk::LocalColumn RowBuilder::local_column(std::uint32_t column) {
  std::uint32_t& mark = in_chunk_.mark[column];
  if (mark <= in_chunk_.last) {
    chunk_.column.push_back(column);
    mark = in_chunk_.last + std::uint32_t(chunk_.column.size());
  }
  return RowChunk::LocalColumn(mark - in_chunk_.last - 1);
}

// Place of the row's numbers in the chunk: that of an equal one among the latest rows, else the
// end.
std::uint32_t RowBuilder::keep_numbers() {
  // Balances the time of comparisons against the memory of equal rows, which are near one another.
  constexpr std::size_t most_compared = 24;
  std::vector<float>& all = chunk_.number;
  for (std::size_t k = distinct_.size(); k > 0 && k + most_compared > distinct_.size(); --k) {
    const std::uint32_t first = distinct_[k - 1];
    if (first + number_.size() <= all.size() &&
        std::equal(number_.begin(), number_.end(), all.begin() + first))
      return first;
  }
  distinct_.push_back(std::uint32_t(all.size()));
  all.insert(all.end(), number_.begin(), number_.end());
  return distinct_.back();
}

float AssembledMatrix::diagonal(std::size_t row) const {
  const RowChunk& chunk = chunk_[row / chunk_rows];
  const std::size_t r = row % chunk_rows;
  float sum = 0;
  for (std::uint32_t begin = r == 0 ? 0 : chunk.row[r - 1].end, k = begin; k < chunk.row[r].end;
       ++k)
    if (chunk.column[chunk.local_column[k]] == row)
      sum += chunk.number[chunk.row[r].number + k - begin];
  return sum;
}

}  // namespace fairing
