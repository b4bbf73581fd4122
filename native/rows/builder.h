// SPDX-License-Identifier: GPL-3.0-or-later
// Sums rows of a sparse matrix, one after another.
#pragma once

#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include "rows/chunk.h"

namespace fairing {

class RowBuilder {
 public:
  // For columns 0 … columns - 1.
  explicit RowBuilder(std::size_t columns)
      : seen_(static_cast<std::uint32_t*>(std::calloc(columns, sizeof(std::uint32_t)))) {
    if (!seen_) throw std::bad_alloc();
  }

  // To the row's number in a column.
  void add(Index column, double number) { sum_[place_of(column)] += number; }

  // The row goes to the chunk, its columns in the order in which they were first named.
  void finish(RowChunk& chunk) {
    for (const double sum : sum_) chunk.number.push_back(float(sum));
    chunk.column.insert(chunk.column.end(), column_.begin(), column_.end());
    for (; chunk.number.size() % row_block != 0; chunk.number.push_back(0))
      chunk.column.push_back(column_.empty() ? 0 : column_.front());
    chunk.row_end.push_back(std::uint32_t(chunk.column.size()));
    start_ += std::uint32_t(sum_.size());
    sum_.clear();
    column_.clear();
  }

 private:
  struct Free {
    void operator()(void* p) const { std::free(p); }
  };

  // `seen_` is 1 + the place among the columns of all rows so far.
  std::size_t place_of(Index column) {
    std::uint32_t& seen = seen_.get()[column];
    if (seen <= start_) {
      column_.push_back(std::uint32_t(column));
      sum_.push_back(0);
      seen = start_ + std::uint32_t(sum_.size());
    }
    return seen - start_ - 1;
  }

  std::unique_ptr<std::uint32_t, Free> seen_;  // pages that no row touches are never made
  std::uint32_t start_ = 0;
  std::vector<double> sum_;
  std::vector<std::uint32_t> column_;
};

}  // namespace fairing
