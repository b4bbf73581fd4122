// SPDX-License-Identifier: GPL-3.0-or-later
#include "rows/matrix.h"

#include "execution/cancel.h"

namespace fairing {
namespace {

template <class Visit>
void visit_numbers(const RowChunk& chunk, Visit&& visit) {
  std::uint32_t k = 0;
  for (std::size_t r = 0; r < chunk.row.size(); ++r)
    for (const float* number = chunk.number.data() + chunk.row[r].number; k < chunk.row[r].end; ++k, ++number)
      if (*number != 0) visit(r, std::size_t(chunk.column[chunk.place[k]]), *number);
}

}  // namespace

float WrittenMatrix::diagonal(std::size_t row) const {
  const RowChunk& chunk = chunk_[row / chunk_rows];
  const std::size_t r = row % chunk_rows;
  float sum = 0;
  for (std::uint32_t begin = r == 0 ? 0 : chunk.row[r - 1].end, k = begin; k < chunk.row[r].end; ++k)
    if (chunk.column[chunk.place[k]] == row) sum += chunk.number[chunk.row[r].number + k - begin];
  return sum;
}

WrittenMatrix::Columns WrittenMatrix::by_columns() const {
  Columns out;
  out.first.assign(columns_ + 1, 0);
  for (const RowChunk& chunk : chunk_) {
    stop_if_cancelled();
    visit_numbers(chunk, [&](std::size_t, std::size_t column, float) { ++out.first[column + 1]; });
  }
  for (std::size_t c = 0; c < columns_; ++c) out.first[c + 1] += out.first[c];
  out.entry.resize(out.first.back());
  std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
  for (std::size_t c = 0; c < chunk_.size(); ++c) {
    stop_if_cancelled();
    visit_numbers(chunk_[c], [&](std::size_t row, std::size_t column, float number) {
      out.entry[next[column]++] = {Index(c * chunk_rows + row), number};
    });
  }
  return out;
}

}  // namespace fairing
