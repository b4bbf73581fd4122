// SPDX-License-Identifier: GPL-3.0-or-later
// A sparse matrix in single precision, whose rows can be finished by more than the product where they are computed.
#pragma once

#include <algorithm>
#include <atomic>

#include "execution/memory.h"
#include "execution/workers.h"
#include "rows/builder.h"

namespace fairing {

class WrittenMatrix {
 public:
  WrittenMatrix(std::size_t rows, std::size_t columns) : rows_(rows), columns_(columns) {}
  WrittenMatrix(const WrittenMatrix&) = delete;
  WrittenMatrix& operator=(const WrittenMatrix&) = delete;
  ~WrittenMatrix() { MemoryLedger::remove(bytes_); }

  // make_writer()(row, builder) adds the numbers of one row after another, a writer on each stretch of them; none: the row
  // is zero. False: the matrix has too many columns in one place, and is not to be used.
  template <class MakeWriter>
  bool build(Workers& workers, MakeWriter&& make_writer) {
    chunk_.resize((rows_ + chunk_rows - 1) / chunk_rows);
    std::atomic<bool> fits = true;
    workers.for_parts(chunk_.size(), 4, [&](std::size_t begin, std::size_t end) {
      RowBuilder builder(columns_);
      auto write = make_writer();
      for (std::size_t c = begin; c < end; ++c) {
        builder.begin_chunk();
        for (std::size_t r = c * chunk_rows; r < std::min(rows_, (c + 1) * chunk_rows); ++r) {
          write(Index(r), builder);
          builder.finish();
        }
        if (!builder.fits()) fits = false;
        chunk_[c] = builder.chunk();  // no longer than it need be
      }
    });
    for (const RowChunk& chunk : chunk_) bytes_ += chunk.bytes();
    MemoryLedger::add(bytes_);
    return fits;
  }

  // The number of a row in its own column; 0 where the row is zero.
  float diagonal(std::size_t row) const;

  // Its numbers column by column: first[c] … first[c + 1] of (row, number).
  struct Columns {
    std::vector<std::size_t> first;
    std::vector<std::pair<Index, float>> entry;
  };
  Columns by_columns() const;

  // Calls finish(row, count, image), with image the matrix times x on so many rows, C numbers a row, 1 or 3; x has
  // `vector_room` more.
  template <int C, class Finish>
  void visit_images(const float* x, Workers& workers, const Finish& finish) const {
    constexpr std::size_t grain = 8;  // chunks worth a thread
    workers.for_parts(chunk_.size(), grain, [&](std::size_t begin, std::size_t end) {
      alignas(64) float image[C * chunk_rows + 4];
      for (std::size_t c = begin; c < end; ++c) {
        chunk_image<C>(chunk_[c], x, image);
        finish(c * chunk_rows, chunk_[c].row.size(), static_cast<float*>(image));
      }
    });
  }

  // y <- the matrix times x
  template <int C>
  void apply(const float* x, Workers& workers, float* y) const {
    visit_images<C>(x, workers, [=](std::size_t row, std::size_t count, const float* image) {
      std::copy_n(image, C * count, y + C * row);
    });
  }

 private:
  std::size_t rows_, columns_, bytes_ = 0;
  Array<RowChunk> chunk_;
};

}  // namespace fairing
