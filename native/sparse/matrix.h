// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse matrices in single precision, for many applications inside a preconditioner.
//
// Their cost is reading them. So they are stored in chunks of rows: a row has 16-bit indices into
// the columns of its chunk, and equal rows, which are many along an edge and inside a face, share
// their numbers: between 2 and 6 bytes an entry instead of 8.
//
// Immutable.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/types.h"
#include "parallel/memory.h"
#include "parallel/workers.h"

namespace fairing {

// Whether rows are faster on a level of n subdivisions and so many points: where faces are small,
// passes over faces and edges cost more than an index for each number; where they are large, rows
// cost more memory and time to read it. Passes `on_surface` read a row for each point as well.
constexpr bool has_rows(int n, std::size_t points, bool on_surface = false) {
  // Measured: with 32 pieces an edge rows take a tenth to a fourth longer, on a surface 0.6 times as
  // long.
  return n > 1 && n <= (on_surface ? 32 : 16) && points <= std::size_t(1) << 22;
}

// Whether rows summed from `products` terms, over all points, are worth their pattern: on average
// the square of a point's ring, 49 or 81 for regular rings.
constexpr bool worth_products(std::size_t products, std::size_t points) {
  constexpr std::size_t most_products = 128;  // per point
  return products < most_products * points;
}

// Rows of a chunk: enough to share columns and numbers, few enough that the chunk's part of a
// vector, and its product, stay in a near cache.
constexpr std::size_t chunk_rows = 256;
// Rows are padded with zeros to whole blocks, one partial sum for each place in a block.
constexpr std::uint32_t row_block = 4;

struct RowChunk {
  using LocalColumn = std::uint16_t;
  struct Row {
    std::uint32_t end;     // of its local columns; a zero row has none
    std::uint32_t number;  // the first of as many
  };
  std::vector<std::uint32_t> column;  // those of the chunk, each once
  std::vector<Row> row;
  std::vector<LocalColumn> local_column;  // row by row: indices into `column`
  std::vector<float> number;

  void clear() {
    column.clear();
    row.clear();
    local_column.clear();
    number.clear();
  }
  std::size_t bytes() const {
    return column.capacity() * sizeof(std::uint32_t) + row.capacity() * sizeof(Row) +
           local_column.capacity() * sizeof(LocalColumn) + number.capacity() * sizeof(float);
  }
};

// Calls visit(row of the chunk, column of the chunk, number) for all numbers except padding.
template <class Visit>
void visit_chunk(const RowChunk& chunk, const Visit& visit) {
  std::uint32_t k = 0;
  for (std::size_t r = 0; r < chunk.row.size(); ++r)
    for (std::uint32_t number = chunk.row[r].number; k < chunk.row[r].end; ++k, ++number)
      if (chunk.number[number] != 0)
        visit(r, std::size_t(chunk.local_column[k]), chunk.number[number]);
}

// product <- the chunk's rows times x: three numbers a row, and one number beyond. x has three
// numbers a column and `vector_room` (multigrid/level_operator.h) more. The order of operations is
// the same on all machines.
void chunk_product(const RowChunk& chunk, const float* x, float* product);

// Sums the rows of a chunk, one after another, in double precision.
class RowBuilder {
 public:
  // For columns 0 … columns - 1.
  explicit RowBuilder(std::size_t columns)
      : in_row_(thread_column_marks()[0]), in_chunk_(thread_column_marks()[1]) {
    in_row_.fit(columns);
    in_chunk_.fit(columns);
  }

  // Clears the marks that an exception has left, for the thread's next builder.
  ~RowBuilder() {
    in_row_.last += std::uint32_t(column_.size());
    in_chunk_.last += std::uint32_t(chunk_.column.size());
  }
  RowBuilder(const RowBuilder&) = delete;
  RowBuilder& operator=(const RowBuilder&) = delete;

  void begin_chunk() {
    in_chunk_.last += std::uint32_t(chunk_.column.size());
    chunk_.clear();
    distinct_.clear();
    ++chunks_;
  }

  // Adds to the row's number in a column.
  void add(Index column, double number) {
    std::uint32_t& mark = in_row_.mark[column];
    if (mark <= in_row_.last) {
      column_.push_back(std::uint32_t(column));
      sum_.push_back(0);
      mark = in_row_.last + std::uint32_t(sum_.size());
    }
    sum_[mark - in_row_.last - 1] += number;
  }

  // Number of the row's columns so far, in the order in which they were named.
  std::size_t columns() const { return column_.size(); }
  bool names(Index column) const { return in_row_.mark[column] > in_row_.last; }
  std::size_t place(Index column) const { return in_row_.mark[column] - in_row_.last - 1; }

  // A row's numbers, to be shared by equal rows.
  class Numbers {
    friend RowBuilder;
    std::vector<float> number_;
    std::size_t chunk_ = 0;  // the chunk that has them, counted from one; 0: none yet
    std::uint32_t first_ = 0;
  };
  void copy_numbers(Numbers& numbers) const {
    numbers.number_.assign(sum_.begin(), sum_.end());
    numbers.chunk_ = 0;
  }
  // Gives the empty row these numbers in these columns. False, and the row stays empty, if a column
  // is named twice. `numbers` must live until finish().
  bool repeat(Numbers& numbers, std::span<const Index> columns);

  // Moves the row to the chunk, its columns in the order in which they were first named.
  void finish();

  const RowChunk& chunk() const { return chunk_; }
  // Whether 16 bits suffice for the chunk's columns.
  bool fits() const {
    return chunk_.column.size() <= std::numeric_limits<RowChunk::LocalColumn>::max();
  }

 private:
  RowChunk::LocalColumn local_column(std::uint32_t column);
  std::uint32_t first_number();
  std::uint32_t keep_numbers();

  // Places of the columns of the row and the chunk, counted from `last`.
  ColumnMarks &in_row_, &in_chunk_;
  RowChunk chunk_;
  std::vector<std::uint32_t> distinct_;  // starts of distinct rows of numbers
  std::size_t chunks_ = 0;               // begun
  // Of the current row.
  std::vector<std::uint32_t> column_;
  std::vector<double> sum_;
  std::vector<float> number_;
  Numbers* repeated_ = nullptr;
};

class AssembledMatrix {
 public:
  // make_writer() makes a writer for each stretch of rows of a thread; writer(row, builder) adds
  // the numbers of one row after another; a row without numbers is zero. Null if a chunk has too
  // many columns. Throws FairingError(cancelled).
  template <class MakeWriter>
  static std::unique_ptr<const AssembledMatrix> make(std::size_t rows, std::size_t columns,
                                                     Workers& workers, MakeWriter&& make_writer) {
    Array<RowChunk> chunks((rows + chunk_rows - 1) / chunk_rows);
    std::atomic<bool> fits = true;
    workers.for_parts(chunks.size(), 1, [&](std::size_t begin, std::size_t end) {
      RowBuilder builder(columns);
      auto write = make_writer();
      for (std::size_t c = begin; c < end; ++c) {
        builder.begin_chunk();
        for (std::size_t r = c * chunk_rows; r < std::min(rows, (c + 1) * chunk_rows); ++r) {
          write(Index(r), builder);
          builder.finish();
        }
        if (!builder.fits()) fits = false;
        chunks[c] = builder.chunk();  // a copy, so that its vectors have no spare capacity
      }
    });
    if (!fits) return nullptr;
    std::size_t bytes = 0;
    for (const RowChunk& chunk : chunks) bytes += chunk.bytes();
    return std::unique_ptr<AssembledMatrix>(new AssembledMatrix(std::move(chunks), bytes));
  }

  // The diagonal number of a row; 0 for a zero row.
  float diagonal(std::size_t row) const;

  // Calls visit(row, column, number) for all numbers, in parallel; a row is visited by one thread.
  template <class Visit>
  void visit_numbers(Workers& workers, const Visit& visit) const {
    workers.for_each(chunk_.size(), 1, [&](std::size_t c) {
      visit_chunk(chunk_[c], [&](std::size_t row, std::size_t column, float number) {
        visit(Index(c * chunk_rows + row), Index(chunk_[c].column[column]), number);
      });
    });
  }

  // Calls finish(row, count, product) on blocks of rows, in parallel, with product the matrix times
  // x there, three numbers a row, still in the cache. x has `vector_room` extra numbers.
  template <class Finish>
  void visit_products(const float* x, Workers& workers, const Finish& finish) const {
    workers.for_each(chunk_.size(), 1, [&](std::size_t c) {
      alignas(64) float product[3 * chunk_rows + 4];
      chunk_product(chunk_[c], x, product);
      finish(c * chunk_rows, chunk_[c].row.size(), static_cast<float*>(product));
    });
  }

 private:
  AssembledMatrix(Array<RowChunk> chunks, std::size_t bytes)
      : chunk_(std::move(chunks)), bytes_(bytes) {}

  Array<RowChunk> chunk_;
  CountedBytes bytes_;
};

}  // namespace fairing
