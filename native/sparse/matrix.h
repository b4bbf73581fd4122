// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse matrices in single precision, for the many applications inside a preconditioner.
//
// What a large matrix costs is reading it. So it is kept in chunks of rows: a row names its columns
// by 16-bit indices among those of its chunk, and equal rows, as there are many along an edge and
// inside a face, share their numbers: between 2 and 6 bytes an entry, where rows of 32-bit indices
// take 8.
//
// Not changed once it is made.
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

// Whether a level of n subdivisions and so many points is served by rows: where faces are small,
// passes over faces and edges cost more than an index a number; where they are large, rows cost
// more memory, and the time to read it.
constexpr bool has_rows(int n, std::size_t points) {
  // measured: in 32 pieces an edge rows take a tenth to a fourth longer
  return n > 1 && n <= 16 && points <= std::size_t(1) << 22;
}

// Whether rows summed from `products` terms, over all points, are worth their pattern: on average a
// point's ring times itself, 49 or 81 where rings are regular.
constexpr bool worth_products(std::size_t products, std::size_t points) {
  constexpr std::size_t most_products = 128;  // a point
  return products < most_products * points;
}

// Rows of a chunk: enough to share columns and numbers, few enough that what a chunk reads of a
// vector, and its product, stay in a near cache.
constexpr std::size_t chunk_rows = 256;
// Rows are filled up with zeros to whole blocks, one partial sum for each place in a block.
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

// Calls visit(row of the chunk, which of its columns, number) for all but zeros, which fill up rows.
template <class Visit>
void visit_chunk(const RowChunk& chunk, const Visit& visit) {
  std::uint32_t k = 0;
  for (std::size_t r = 0; r < chunk.row.size(); ++r)
    for (std::uint32_t number = chunk.row[r].number; k < chunk.row[r].end; ++k, ++number)
      if (chunk.number[number] != 0)
        visit(r, std::size_t(chunk.local_column[k]), chunk.number[number]);
}

// product <- the chunk's rows times x: C numbers a row, 1 or 3, and up to one number beyond. x
// holds C numbers a column and `vector_room` (multigrid/level_operator.h) more. Every number sees
// the same operations in the same order on all machines.
template <int C>
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

  // What an exception has left of a row is no mark to the thread's next builder.
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

  // To the row's number in a column.
  void add(Index column, double number) {
    std::uint32_t& mark = in_row_.mark[std::size_t(column)];
    if (mark <= in_row_.last) {
      column_.push_back(std::uint32_t(column));
      sum_.push_back(0);
      mark = in_row_.last + std::uint32_t(sum_.size());
    }
    sum_[mark - in_row_.last - 1] += number;
  }

  // The row's columns so far, in the order in which they were named.
  std::size_t columns() const { return column_.size(); }
  bool names(Index column) const { return in_row_.mark[std::size_t(column)] > in_row_.last; }
  std::size_t place(Index column) const {
    return in_row_.mark[std::size_t(column)] - in_row_.last - 1;
  }

  // A row's numbers, for others that have the same.
  class Numbers {
    friend RowBuilder;
    std::vector<float> number_;
    std::size_t chunk_ = 0;  // that has them, counted from one; 0: none yet
    std::uint32_t first_ = 0;
  };
  void copy_numbers(Numbers& numbers) const {
    numbers.number_.assign(sum_.begin(), sum_.end());
    numbers.chunk_ = 0;
  }
  // The row, still empty, has these numbers in these columns. False, and it stays empty: a column is
  // named twice. `numbers` must live until finish().
  bool repeat(Numbers& numbers, std::span<const Index> columns);

  // The row goes to the chunk, its columns in the order in which they were first named.
  void finish();

  const RowChunk& chunk() const { return chunk_; }
  // Whether 16 bits tell the chunk's columns apart.
  bool fits() const {
    return chunk_.column.size() <= std::numeric_limits<RowChunk::LocalColumn>::max();
  }

 private:
  RowChunk::LocalColumn local_column(std::uint32_t column);
  std::uint32_t first_number();
  std::uint32_t keep_numbers();

  // Which columns the row and the chunk have named: where, counted from `last`.
  ColumnMarks &in_row_, &in_chunk_;
  RowChunk chunk_;
  std::vector<std::uint32_t> distinct_;  // where rows of numbers begin, all different
  std::size_t chunks_ = 0;               // begun
  // Of the row at hand.
  std::vector<std::uint32_t> column_;
  std::vector<double> sum_;
  std::vector<float> number_;
  Numbers* repeated_ = nullptr;
};

// Numbers column by column: first[c] … first[c + 1] of the entries, rows ascending.
struct MatrixColumns {
  struct Entry {
    Index row;
    float number;
  };
  std::vector<std::size_t> first;
  std::unique_ptr<Entry[]> entry;
};

class AssembledMatrix {
 public:
  // make_writer() gives a writer, one for each stretch of rows that a thread takes; writer(row,
  // builder) adds the numbers of one row after another; none: the row is zero. Null: it would have
  // too many columns in one chunk. Throws where the run has been cancelled.
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
        chunks[c] = builder.chunk();  // a copy: its vectors are no longer than they need be
      }
    });
    if (!fits) return nullptr;
    std::size_t bytes = 0;
    for (const RowChunk& chunk : chunks) bytes += chunk.bytes();
    return std::unique_ptr<AssembledMatrix>(new AssembledMatrix(columns, std::move(chunks), bytes));
  }

  // The number of a row in its own column; 0 where the row is zero.
  float diagonal(std::size_t row) const;

  // Throws where the run has been cancelled.
  MatrixColumns by_columns(Workers& workers) const;

  // Calls visit(row, column, number) for all numbers, in parallel: those of a row on one thread.
  template <class Visit>
  void visit_numbers(Workers& workers, const Visit& visit) const {
    workers.for_parts(chunk_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c)
        visit_chunk(chunk_[c], [&](std::size_t row, std::size_t column, float number) {
          visit(Index(c * chunk_rows + row), Index(chunk_[c].column[column]), number);
        });
    });
  }

  // Calls finish(row, count, product) on blocks of rows, in parallel, with product the matrix times
  // x there, C numbers a row, 1 or 3: what comes after the product is done while it is in the
  // cache. x has `vector_room` more.
  template <int C, class Finish>
  void visit_products(const float* x, Workers& workers, const Finish& finish) const {
    workers.for_parts(chunk_.size(), 1, [&](std::size_t begin, std::size_t end) {
      alignas(64) float product[C * chunk_rows + 4];
      for (std::size_t c = begin; c < end; ++c) {
        chunk_product<C>(chunk_[c], x, product);
        finish(c * chunk_rows, chunk_[c].row.size(), static_cast<float*>(product));
      }
    });
  }

  // y <- the matrix times x
  template <int C>
  void apply(const float* x, Workers& workers, float* y) const {
    visit_products<C>(x, workers, [=](std::size_t row, std::size_t count, const float* product) {
      std::copy_n(product, C * count, y + C * row);
    });
  }

 private:
  AssembledMatrix(std::size_t columns, Array<RowChunk> chunks, std::size_t bytes)
      : columns_(columns), chunk_(std::move(chunks)), bytes_(bytes) {}

  std::size_t columns_;
  Array<RowChunk> chunk_;
  CountedBytes bytes_;
};

}  // namespace fairing
