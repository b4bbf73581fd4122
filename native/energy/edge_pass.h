// SPDX-License-Identifier: GPL-3.0-or-later
// The thin plate's two one-ring passes along a control edge, whose points all have one stencil: moments first, then
// the transposed rows of the moments. Blocks of 8 numbers; lanes have room for a whole last block.
#pragma once

#include <algorithm>

#include "execution/wide.h"
#include "lattice/ring.h"

namespace fairing {

namespace passes {

template <class T, int Bytes>
struct EdgePass {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;

  // m[c][i] = sum_j row[8 c + j] (neighbour j of i - i) on the run's points 1 … n - 1, zero elsewhere; then target
  // lanes get the transposed rows. moments: 5 lanes' room. weight, if not null: factors of the m, one a point from 1.
  DF_INLINE static void run(int n, const EdgeRingLanes* ring, const T* row, T scale, T* const* lane,
                            const T* weight, T* const* target, T* moments) {
    constexpr int block = P::size, room = lane_block;
    const std::ptrdiff_t stride = std::ptrdiff_t(lane_stride(n)) + 2 * room;
    const std::ptrdiff_t inner = 3 * std::ptrdiff_t(n - 1), whole = 3 * std::ptrdiff_t(n + 1);
    T* m[3] = {moments + room, moments + room + stride, moments + room + 2 * stride};
    const T* centre = lane[0] + 3;
    const int size = ring->size;
    const T* place[8];
    T at[3][8], back[3][8], total[3] = {};
    for (int j = 0; j < size; ++j) {
      place[j] = lane[ring->lane[j]] + 3 * (1 + ring->at[j]);
      for (int c = 0; c < 3; ++c) {
        at[c][j] = row[8 * c + j];
        back[c][j] = scale * row[8 * c + j];
        total[c] -= back[c][j];
      }
    }
    for (std::ptrdiff_t i = 0; i < inner; i += block) {
      Pack own, y0 = {}, y1 = {}, y2 = {};
      P::load(centre + i, own);
      for (int j = 0; j < size; ++j) {
        Pack d;
        P::load(place[j] + i, d);
        d -= own;
        y0 += at[0][j] * d;
        y1 += at[1][j] * d;
        y2 += at[2][j] * d;
      }
      P::store(y0, m[0] + 3 + i);
      P::store(y1, m[1] + 3 + i);
      P::store(y2, m[2] + 3 + i);
    }
    if (weight)
      for (int c = 0; c < 3; ++c)
        for (std::ptrdiff_t i = 0; i < inner; ++i) m[c][3 + i] *= weight[i / 3];
    for (int c = 0; c < 3; ++c) {
      for (int q = -3; q < 3; ++q) m[c][q] = 0;
      for (std::ptrdiff_t q = 3 + inner; q < stride - room; ++q) m[c][q] = 0;
    }
    for (int l = 0; l < 3; ++l) {
      if (!target[l]) continue;
      for (std::ptrdiff_t i = 0; i < whole; i += block) {
        Pack z = {};
        const auto add = [&](const T* b0, const T* b1, const T* b2, std::ptrdiff_t from)
                             __attribute__((always_inline)) {
                               Pack a, b, c;
                               P::load(m[0] + from, a);
                               P::load(m[1] + from, b);
                               P::load(m[2] + from, c);
                               z += *b0 * a + *b1 * b + *b2 * c;
                             };
        for (int j = 0; j < size; ++j)
          if (ring->lane[j] == l) add(&back[0][j], &back[1][j], &back[2][j], i - 3 * ring->at[j]);
        if (l == 0) add(&total[0], &total[1], &total[2], i);
        P::store(z, target[l] + i);
      }
    }
  }
};

}  // namespace passes

// target lanes <- (rows)^T rows (lanes), scaled; storage holds 5 lanes.
template <class T>
void set_edge_pass(int n, const EdgeRingLanes& ring, const T* row, T scale, T* const* lane, const T* weight,
                   T* const* target, T* storage) {
  run_loop<passes::EdgePass, T>(n, &ring, row, scale, lane, weight, target, storage);
}

}  // namespace fairing
