// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/matrix.h"

#include <utility>

#include "base/simd.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Four = Packs<float, 16>;

// C numbers of each of the chunk's columns: three of them in packs of four.
template <int C>
constexpr std::size_t local_stride = C == 3 ? 4 : 1;

template <int C>
DF_INLINE void gather(const RowChunk& chunk, const float* x, float* local) {
  for (const std::uint32_t column : chunk.column) {
    if constexpr (C == 3) {
      Four::Pack p;
      Four::load(x + 3 * std::size_t(column), p);
      Four::store(p, local);
    } else {
      *local = x[column];
    }
    local += local_stride<C>;
  }
}

DF_INLINE void set_row(const RowChunk::LocalColumn* column, const RowChunk::LocalColumn* end,
                       const float* number, const float* local, float* product,
                       std::integral_constant<int, 3>) {
  Four::Pack sum[row_block] = {}, p;
  for (; column < end; column += row_block, number += row_block)
#pragma GCC unroll 4
    for (std::size_t m = 0; m < row_block; ++m) {
      Four::load(local + 4 * std::size_t(column[m]), p);
      sum[m] += number[m] * p;
    }
  Four::store((sum[0] + sum[1]) + (sum[2] + sum[3]), product);
}

DF_INLINE void set_row(const RowChunk::LocalColumn* column, const RowChunk::LocalColumn* end,
                       const float* number, const float* local, float* product,
                       std::integral_constant<int, 1>) {
  float sum[row_block] = {};
  for (; column < end; column += row_block, number += row_block)
#pragma GCC unroll 4
    for (std::size_t m = 0; m < row_block; ++m) sum[m] += number[m] * local[column[m]];
  *product = (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

template <int C>
struct RowsLoop {
  template <class T, int Bytes>
  struct Of {
    DF_INLINE static void run(const RowChunk* chunk, const float* x, float* local, float* product) {
      gather<C>(*chunk, x, local);
      const RowChunk::LocalColumn* column = chunk->local_column.data();
      for (const RowChunk::Row& row : chunk->row) {
        const RowChunk::LocalColumn* const end = chunk->local_column.data() + row.end;
        set_row(column, end, chunk->number.data() + row.number, local, product,
                std::integral_constant<int, C>());
        column = end;
        product += C;
      }
    }
  };
};

}  // namespace

template <int C>
void chunk_product(const RowChunk& chunk, const float* x, float* product) {
  float* const local =
      room_in(thread_scratch<float>().columns, local_stride<C> * chunk.column.size());
  run_loop<RowsLoop<C>::template Of, float>(&chunk, x, local, product);
}
template void chunk_product<1>(const RowChunk&, const float*, float*);
template void chunk_product<3>(const RowChunk&, const float*, float*);

bool RowBuilder::repeat(Numbers& numbers, std::span<const Index> columns) {
  for (const Index column : columns) {
    if (names(column)) {
      in_row_.last += std::uint32_t(column_.size());
      column_.clear();
      return false;
    }
    column_.push_back(std::uint32_t(column));
    in_row_.mark[std::size_t(column)] = in_row_.last + std::uint32_t(column_.size());
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

// Where the chunk keeps the row's numbers: with one of the latest rows that differ from one
// another, if it is equal, or else at the end.
std::uint32_t RowBuilder::keep_numbers() {
  // Balances the time to compare with what equal rows save: those alike are near one another.
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

// Chunks count their own numbers, and put them where those of the chunks before them end.
MatrixColumns AssembledMatrix::by_columns(Workers& workers) const {
  std::vector<std::vector<std::uint32_t>> place(chunk_.size());  // of each chunk, by its columns
  const auto visit_all = [&](auto&& visit) {
    workers.for_parts(chunk_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) {
        place[c].resize(chunk_[c].column.size(), 0);
        visit_chunk(chunk_[c], [&](std::size_t row, std::size_t column, float number) {
          visit(Index(c * chunk_rows + row), place[c][column]++, number);
        });
      }
    });
  };
  const auto visit_places = [&](auto&& visit) {
    for (std::size_t c = 0; c < chunk_.size(); ++c)
      for (std::size_t k = 0; k < place[c].size(); ++k) visit(chunk_[c].column[k], place[c][k]);
  };
  visit_all([](Index, std::uint32_t, float) {});
  MatrixColumns out;
  out.first.assign(columns_ + 1, 0);
  visit_places([&](std::size_t column, std::uint32_t count) { out.first[column + 1] += count; });
  for (std::size_t c = 0; c < columns_; ++c) out.first[c + 1] += out.first[c];
  std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
  visit_places([&](std::size_t column, std::uint32_t& count) {
    count = std::exchange(next[column], next[column] + count);
  });
  out.entry = std::make_unique_for_overwrite<MatrixColumns::Entry[]>(out.first.back());
  visit_all([&](Index row, std::uint32_t at, float number) { out.entry[at] = {row, number}; });
  return out;
}

}  // namespace fairing
