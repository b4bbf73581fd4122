// SPDX-License-Identifier: GPL-3.0-or-later
// A sparse matrix in single precision whose rows are written, or zero.
#pragma once

#include <algorithm>

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

  // write(row, builder) adds the numbers of a row; rows without has_row(row) are zero.
  template <class HasRow, class Write>
  void build(Workers& workers, HasRow&& has_row, Write&& write) {
    chunk_.resize((rows_ + chunk_points - 1) / chunk_points);
    workers.for_parts(chunk_.size(), 4, [&](std::size_t begin, std::size_t end) {
      RowBuilder builder(columns_);
      for (std::size_t c = begin; c < end; ++c)
        for (std::size_t r = c * chunk_points; r < std::min(rows_, (c + 1) * chunk_points); ++r) {
          const bool written = has_row(Index(r));
          append_to_runs(chunk_[c].runs, written);
          if (!written) continue;
          write(Index(r), builder);
          builder.finish(chunk_[c]);
        }
    });
    for (const RowChunk& chunk : chunk_) bytes_ += chunk.bytes();
    MemoryLedger::add(bytes_);
  }

  // Its transpose, column by column of this one: first[c] … first[c + 1] of (row, number).
  struct Columns {
    std::vector<std::size_t> first;
    std::vector<std::pair<Index, float>> entry;
  };
  Columns by_columns() const;

  // y <- this x, with C numbers a point, 1 or 3; x has `vector_room` more.
  template <int C>
  void apply(const float* x, Workers& workers, float* y) const;

 private:
  static void append_to_runs(std::vector<ChunkRun>& runs, bool written) {
    const ChunkRun::Kind kind = written ? ChunkRun::written : ChunkRun::zero;
    if (runs.empty() || runs.back().kind != kind) runs.push_back({kind, 0, 0, 0});
    ++runs.back().count;
  }

  std::size_t rows_, columns_, bytes_ = 0;
  Array<RowChunk> chunk_;
};

}  // namespace fairing
