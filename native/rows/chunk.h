// SPDX-License-Identifier: GPL-3.0-or-later
// A block of points, the rows of a sparse matrix there, and what they make of a vector. Every number sees the same operations in the same order
// whatever the width of packs.
#pragma once

#include <cstdint>
#include <vector>

#include "execution/wide.h"
#include "lattice/lattice.h"

namespace fairing {

// Points one after another whose rows are of one kind: zero, written, or along row `row` of a face.
struct ChunkRun {
  enum Kind : std::int32_t { zero, written, triangle, quad } kind;
  Index count;
  Index face, row;  // of stencils
};

struct RowChunk {
  std::vector<ChunkRun> runs;
  std::vector<std::uint32_t> row_end;  // of the written rows, one after another
  std::vector<std::uint32_t> column;   // points
  std::vector<float> number;           // rows are filled up with zeros to whole blocks

  std::size_t bytes() const {
    return runs.capacity() * sizeof(ChunkRun) +
           (row_end.capacity() + column.capacity() + number.capacity()) * sizeof(float);
  }
};
constexpr std::size_t chunk_points = 256;
constexpr std::uint32_t row_block = 4;

// A row deep inside a face: neighbours at opposite places share a number.
struct FaceStencil {
  float centre, pair[12];
};

// The first of each pair: half of the places within two lattice steps.
struct StencilPlaces {
  int count;
  LatticePoint at[12];
};
constexpr StencilPlaces triangle_places{
    9, {{1, 0}, {2, 0}, {-2, 1}, {-1, 1}, {0, 1}, {1, 1}, {-2, 2}, {-1, 2}, {0, 2}, {}, {}, {}}};
constexpr StencilPlaces quad_places{
    12, {{1, 0}, {2, 0}, {-2, 1}, {-1, 1}, {0, 1}, {1, 1}, {2, 1}, {-2, 2}, {-1, 2}, {0, 2}, {1, 2}, {2, 2}}};

// A written row's sum, with C numbers a point; of three, a fourth is written that is nobody's.
template <int C>
struct WrittenRow {
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
struct WrittenRow<1> {
  DF_INLINE static void run(const std::uint32_t* column, const float* number, std::uint32_t k,
                            std::uint32_t end, const float* x, float* image) {
    float sum[row_block] = {};
    for (; k < end; k += row_block)
#pragma GCC unroll 4
      for (std::uint32_t m = 0; m < row_block; ++m) sum[m] += number[k + m] * x[column[k + m]];
    *image = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
};

// Writes K x on a chunk's points, and up to a pack beyond.
template <int Bytes>
struct ChunkImage {
  using P = Packs<float, Bytes>;

  DF_INLINE static void run(const RowChunk& chunk, const FaceStencil* stencils, int n, std::size_t point,
                            const float* x, float* image) {
    const std::uint32_t* column = chunk.column.data();
    const float* number = chunk.number.data();
    const std::uint32_t* row_end = chunk.row_end.data();
    std::uint32_t k = 0;
    for (const ChunkRun& run : chunk.runs) {
      switch (run.kind) {
        case ChunkRun::zero:
          for (Index i = 0; i < 3 * run.count; ++i) image[i] = 0;
          break;
        case ChunkRun::written:
          for (Index i = 0; i < run.count; ++i) {
            WrittenRow<3>::run(column, number, k, *row_end, x, image + 3 * i);
            k = *row_end++;
          }
          break;
        case ChunkRun::triangle: row<false>(stencils[run.face], n, run, x + 3 * point, image); break;
        case ChunkRun::quad: row<true>(stencils[run.face], n, run, x + 3 * point, image); break;
      }
      point += std::size_t(run.count);
      image += 3 * run.count;
    }
  }

 private:
  template <bool is_quad>
  DF_INLINE static void row(const FaceStencil& stencil, int n, const ChunkRun& run, const float* x,
                            float* image) {
    constexpr StencilPlaces places = is_quad ? quad_places : triangle_places;
    const auto start = [&](int j) {
      return std::ptrdiff_t(interior_row(is_quad, std::size_t(n), std::size_t(j)));
    };
    const std::ptrdiff_t here = start(run.row);
    const float* line[5];  // rows two below to two above
    for (int j = -2; j <= 2; ++j) line[j + 2] = x + 3 * (start(run.row + j) - here);
    for (std::ptrdiff_t i = 0; i < 3 * std::ptrdiff_t(run.count); i += P::size) {
      typename P::Pack p, q, sum;
      P::load(line[2] + i, p);
      sum = stencil.centre * p;
#pragma GCC unroll 12
      for (int k = 0; k < places.count; ++k) {
        P::load(line[2 + places.at[k].j] + i + 3 * places.at[k].i, p);
        P::load(line[2 - places.at[k].j] + i - 3 * places.at[k].i, q);
        sum += stencil.pair[k] * (p + q);
      }
      P::store(sum, image + i);
    }
  }
};

}  // namespace fairing
