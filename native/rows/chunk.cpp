// SPDX-License-Identifier: GPL-3.0-or-later
#include "rows/chunk.h"

#include "execution/scratch.h"
#include "execution/wide.h"

namespace fairing {
namespace {

using Four = Packs<float, 16>;

// C numbers of each of the chunk's columns: three of them in packs of four.
template <int C>
constexpr std::size_t local_stride = C == 3 ? 4 : 1;

template <int C>
DF_INLINE void gather(const RowChunk& chunk, const float* x, float* local) {
  for (const std::uint32_t column : chunk.column) {
    if constexpr (C == 3) {
      Four::Pack p;
      Four::load(x + 3 * std::size_t(column), p);
      Four::store(p, local);
    } else {
      *local = x[column];
    }
    local += local_stride<C>;
  }
}

DF_INLINE void set_row(const RowChunk::Place* place, const RowChunk::Place* end, const float* number,
                       const float* local, float* image, std::integral_constant<int, 3>) {
  Four::Pack sum[row_block] = {}, p;
  for (; place < end; place += row_block, number += row_block)
#pragma GCC unroll 4
    for (std::size_t m = 0; m < row_block; ++m) {
      Four::load(local + 4 * std::size_t(place[m]), p);
      sum[m] += number[m] * p;
    }
  Four::store((sum[0] + sum[1]) + (sum[2] + sum[3]), image);
}

DF_INLINE void set_row(const RowChunk::Place* place, const RowChunk::Place* end, const float* number,
                       const float* local, float* image, std::integral_constant<int, 1>) {
  float sum[row_block] = {};
  for (; place < end; place += row_block, number += row_block)
#pragma GCC unroll 4
    for (std::size_t m = 0; m < row_block; ++m) sum[m] += number[m] * local[place[m]];
  *image = (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

template <int C>
struct RowsLoop {
  template <class T, int Bytes>
  struct Of {
    DF_INLINE static void run(const RowChunk* chunk, const float* x, float* local, float* image) {
      gather<C>(*chunk, x, local);
      const RowChunk::Place* place = chunk->place.data();
      for (const RowChunk::Row& row : chunk->row) {
        const RowChunk::Place* const end = chunk->place.data() + row.end;
        set_row(place, end, chunk->number.data() + row.number, local, image,
                std::integral_constant<int, C>());
        place = end;
        image += C;
      }
    }
  };
};

}  // namespace

template <int C>
void chunk_image(const RowChunk& chunk, const float* x, float* image) {
  float* const local = room_in(thread_scratch<float>().columns, local_stride<C> * chunk.column.size());
  run_loop<RowsLoop<C>::template Of, float>(&chunk, x, local, image);
}
template void chunk_image<1>(const RowChunk&, const float*, float*);
template void chunk_image<3>(const RowChunk&, const float*, float*);

}  // namespace fairing
