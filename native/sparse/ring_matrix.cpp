// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse/ring_matrix.h"

#include "base/simd.h"
#include "grid/runs.h"

namespace fairing {
namespace {

using Four = Packs<float, 16>;

// Products of rows with x, C numbers each.
template <int C>
struct RowProducts {
  template <class T, int Bytes>
  struct Of {
    // Several sums a row, so that none waits for another. With three numbers a point, a pack has
    // those of a point.
    DF_INLINE static void run(std::size_t rows, const std::uint32_t* end, const Index* column,
                              const float* number, const float* x, float* y) {
      constexpr std::size_t sums = C == 1 ? 2 : 4;
      Four::Pack p, of;
      std::size_t k = 0;
      for (std::size_t r = 0; r < rows; ++r, y += C) {
        Four::Pack sum[sums] = {};
        const auto add = [&](std::size_t m) __attribute__((always_inline)) {
          Four::load(x + C * std::size_t(column[k + m]), p);
          if constexpr (C == 1) {
            Four::load(number + 4 * (k + m), of);
            sum[m] += of * p;
          } else {
            sum[m] += number[k + m] * p;
          }
        };
        for (; k + sums <= end[r]; k += sums)
#pragma GCC unroll 4
          for (std::size_t m = 0; m < sums; ++m) add(m);
        const std::size_t rest = end[r] - k;
        for (std::size_t m = 0; m < rest; ++m) add(m);
        k += rest;
        p = sum[0] + sum[1];
        if constexpr (C == 1) {
          *y = (p[0] + p[1]) + (p[2] + p[3]);
        } else {
          p += sum[2] + sum[3];
          for (std::size_t a = 0; a < C; ++a) y[a] = p[a];
        }
      }
    }
  };
};

}  // namespace

template <int C>
bool RingMatrix<C>::suits(const GridLevel& grid, int most_pieces) {
  constexpr std::size_t most_products = 128;  // per point; regular rings have 49 or 81
  std::size_t products = 81 * grid.size();
  for (Index v = 0; v < grid.mesh().vertex_count(); ++v) {
    const auto size = std::size_t(neighbours(grid.mesh(), vertex_run(v)) + 1);
    products += size * size;
  }
  return has_matrix(grid.n(), grid.size(), most_pieces) && grid.size() >= width &&
         products < most_products * grid.size();
}

template <int C>
void RingMatrix<C>::append(RowSum& sum, Index last, Chunk& chunk) {
  const std::size_t begin = chunk.column.size();
  for (const auto& [column, number] : sum.sorted()) {
    if (chunk.column.size() == begin || column >= chunk.column.back() + Index(width)) {
      chunk.column.push_back(std::min(column, last));
      chunk.number.resize(chunk.number.size() + width, 0.0f);
    }
    *(chunk.number.end() - std::ptrdiff_t(width) + (column - chunk.column.back())) = float(number);
  }
  chunk.end.push_back(std::uint32_t(chunk.column.size()));
}

template <int C>
void RingMatrix<C>::count_bytes() {
  std::size_t bytes = 0;
  for (const Chunk& chunk : chunk_)
    bytes += sizeof(std::uint32_t) * chunk.end.size() + sizeof(Index) * chunk.column.size() +
             sizeof(float) * chunk.number.size();
  counted_.emplace(bytes);
}

template <int C>
void RingMatrix<C>::apply(const float* x, Workers& workers, float* y) const {
  workers.for_each(chunk_.size(), 1, [&](std::size_t c) {
    const Chunk& chunk = chunk_[c];
    run_loop<RowProducts<C>::template Of, float>(chunk.end.size(), chunk.end.data(),
                                                 chunk.column.data(), chunk.number.data(), x,
                                                 y + C * c * chunk_rows);
  });
}

template class RingMatrix<1>;
template class RingMatrix<3>;

}  // namespace fairing
