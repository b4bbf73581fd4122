// SPDX-License-Identifier: GPL-3.0-or-later
// A block of rows of a sparse matrix. Every number sees the same operations in the same order on all machines.
#pragma once

#include <cstdint>
#include <vector>

#include "execution/wide.h"
#include "lattice/lattice.h"

namespace fairing {

constexpr std::size_t chunk_rows = 256;
constexpr std::uint32_t row_block = 4;

struct RowChunk {
  std::vector<std::uint32_t> row_end;  // of each row among the numbers; zero rows have none
  std::vector<std::uint32_t> column;
  std::vector<float> number;  // rows are filled up with zeros to whole blocks

  void clear() {
    row_end.clear();
    column.clear();
    number.clear();
  }
  std::size_t bytes() const {
    return (row_end.capacity() + column.capacity() + number.capacity()) * sizeof(float);
  }
};

// A row's sum, with C numbers a point; of three, a fourth is written that is nobody's.
template <int C>
struct RowSum {
  DF_INLINE static void run(const std::uint32_t* column, const float* number, std::uint32_t k,
                            std::uint32_t end, const float* x, float* image) {
    using Four = Packs<float, 16>;
    typename Four::Pack sum[row_block] = {}, p;
    for (; k < end; k += row_block)
#pragma GCC unroll 4
      for (std::uint32_t m = 0; m < row_block; ++m) {
        Four::load(x + 3 * std::size_t(column[k + m]), p);
        sum[m] += number[k + m] * p;
      }
    Four::store((sum[0] + sum[1]) + (sum[2] + sum[3]), image);
  }
};
template <>
struct RowSum<1> {
  DF_INLINE static void run(const std::uint32_t* column, const float* number, std::uint32_t k,
                            std::uint32_t end, const float* x, float* image) {
    float sum[row_block] = {};
    for (; k < end; k += row_block)
#pragma GCC unroll 4
      for (std::uint32_t m = 0; m < row_block; ++m) sum[m] += number[k + m] * x[column[k + m]];
    *image = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
};

// image <- a chunk's rows of the matrix times x, and up to one number beyond.
template <int C>
void chunk_image(const RowChunk& chunk, const float* x, float* image);

}  // namespace fairing
