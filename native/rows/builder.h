// SPDX-License-Identifier: GPL-3.0-or-later
// Sums rows of a sparse matrix, one after another.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "execution/scratch.h"
#include "lattice/lattice.h"
#include "rows/chunk.h"

namespace fairing {

class RowBuilder {
 public:
  // For columns 0 … columns - 1.
  explicit RowBuilder(std::size_t columns)
      : in_row_(thread_column_marks()[0]), in_chunk_(thread_column_marks()[1]) {
    in_row_.fit(columns);
    in_chunk_.fit(columns);
  }

  ~RowBuilder() { in_chunk_.last += std::uint32_t(chunk_.column.size()); }
  RowBuilder(const RowBuilder&) = delete;
  RowBuilder& operator=(const RowBuilder&) = delete;

  void begin_chunk() {
    in_chunk_.last += std::uint32_t(chunk_.column.size());
    chunk_.clear();
    distinct_.clear();
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

  // The row goes to the chunk, its columns in the order in which they were first named.
  void finish() {
    for (const std::uint32_t column : column_) chunk_.place.push_back(place_of(column));
    for (const double sum : sum_) number_.push_back(float(sum));
    for (; number_.size() % row_block != 0; number_.push_back(0)) chunk_.place.push_back(chunk_.place.back());
    chunk_.row.push_back({std::uint32_t(chunk_.place.size()), keep_numbers()});
    in_row_.last += std::uint32_t(sum_.size());
    sum_.clear();
    column_.clear();
    number_.clear();
  }

  const RowChunk& chunk() const { return chunk_; }
  // Whether the chunk's columns have places.
  bool fits() const { return chunk_.column.size() <= std::numeric_limits<RowChunk::Place>::max(); }

 private:
  RowChunk::Place place_of(std::uint32_t column) {
    std::uint32_t& mark = in_chunk_.mark[column];
    if (mark <= in_chunk_.last) {
      chunk_.column.push_back(column);
      mark = in_chunk_.last + std::uint32_t(chunk_.column.size());
    }
    return RowChunk::Place(mark - in_chunk_.last - 1);
  }

  // Where the chunk has these numbers, of one of the latest rows that differ, or gets them.
  std::uint32_t keep_numbers() {
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

  ColumnMarks &in_row_, &in_chunk_;
  RowChunk chunk_;
  std::vector<std::uint32_t> distinct_, column_;
  std::vector<double> sum_;
  std::vector<float> number_;
};

}  // namespace fairing
