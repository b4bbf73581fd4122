// SPDX-License-Identifier: GPL-3.0-or-later
// Sums rows of a sparse matrix, one after another.
#pragma once

#include <algorithm>
#include <vector>

#include "execution/scratch.h"
#include "rows/chunk.h"

namespace fairing {

class RowBuilder {
 public:
  // For columns 0 … columns - 1.
  explicit RowBuilder(std::size_t columns) : marks_(thread_column_marks()) {
    constexpr std::uint32_t room_of_marks = std::uint32_t(1) << 31;
    if (marks_.mark.size() < columns) marks_.mark.resize(columns, 0);
    if (marks_.last < room_of_marks) return;
    std::fill(marks_.mark.begin(), marks_.mark.end(), 0);
    marks_.last = 0;
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
    marks_.last += std::uint32_t(sum_.size());
    sum_.clear();
    column_.clear();
  }

 private:
  // A mark is 1 + the place among the columns of all rows so far.
  std::size_t place_of(Index column) {
    std::uint32_t& mark = marks_.mark[std::size_t(column)];
    if (mark <= marks_.last) {
      column_.push_back(std::uint32_t(column));
      sum_.push_back(0);
      mark = marks_.last + std::uint32_t(sum_.size());
    }
    return mark - marks_.last - 1;
  }

  ColumnMarks& marks_;
  std::vector<double> sum_;
  std::vector<std::uint32_t> column_;
};

}  // namespace fairing
