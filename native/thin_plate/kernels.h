// SPDX-License-Identifier: GPL-3.0-or-later
// The inner loops of K's action without a matrix: two one-ring passes, y = C d with the divided
// differences d, then the transposed differences of y. Along a control edge all points have one
// stencil. Inside a control face they have one matrix C on the second differences d_a along the
// grid's directions a,
//
//   d_a(i) = x(i + a) + x(i - a) - 2 x(i),   (K x)(i) = sum_a y_a(i + a) + y_a(i - a) - 2 y_a(i).
//
// So there is no branch and no index.
//
// Rows have three interleaved coordinates, in packs (base/simd.h). What the last pack writes beyond
// a row is overwritten by the next row, or lies in the extra room at the end of each buffer. The
// order of every sum is fixed, because it determines the result's bits.
#pragma once

#include <algorithm>

#include "base/simd.h"
#include "grid/ring.h"

namespace fairing {

namespace passes {

template <class T, int Bytes>
struct EdgePass {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;

  // m[c][i] = sum_j row[8 c + j] (neighbour j of i - i) on the run's points 1 … n - 1, zero
  // elsewhere; then the transposed rows are added to the target lanes. `moments` has room for 5
  // lanes. `weight`, if not null: factors of m, one per point from point 1.
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

constexpr std::ptrdiff_t blocks_of(std::ptrdiff_t numbers) {
  return (numbers + lane_block - 1) / lane_block * lane_block;
}

// Three rolling rows of four moments each, with zeros on both sides of a row's interior points.
// Nothing writes before a row's points, so these zeros, set at the start, remain from face to face.
constexpr std::ptrdiff_t moments_stride(int n) {
  return blocks_of(3 * std::ptrdiff_t(n + 2)) + 2 * lane_block;
}
constexpr std::size_t moments_size(int n) { return std::size_t(12 * moments_stride(n)); }

template <class T, int Bytes>
struct Moments {
  using P = Packs<T, Bytes>;
  std::ptrdiff_t stride;
  T* data;
  // Row j of direction a; element 0 is the point i = 0.
  DF_INLINE T* row(int j, int a) const {
    return data + (((j + 3) % 3) * 4 + a) * stride + lane_block;
  }
  // Clears `count` numbers from number `first` on, rounded up.
  DF_INLINE void clear(int directions, int j, std::ptrdiff_t first, std::ptrdiff_t count) const {
    const typename P::Pack zero = {};
    for (int a = 0; a < directions; ++a)
      for (std::ptrdiff_t i = 0; i < count; i += P::size) P::store(zero, row(j, a) + first + i);
  }
};

// Inside a face: its closed grid row by row; each row of a triangle is one point shorter.
template <bool quad>
struct FacePass {
  static constexpr int directions = quad ? 4 : 3;
  static constexpr std::span<const GridPoint> step = face_directions(quad);
  // The order in which the parts of the transposed differences are added.
  static constexpr int order[4] = {0, quad ? 2 : 1, quad ? 1 : 2, 3};
  static constexpr std::ptrdiff_t shrink = quad ? 0 : 3;

  template <class T, int Bytes>
  struct Of {
    using P = Packs<T, Bytes>;
    using Pack = typename P::Pack;

    // y[a] <- sum_b m[a][b] (second difference along b), for numbers first … last of the row
    // `here`.
    DF_INLINE static void set_moments(const T (&m)[directions][directions], const T* down,
                                      const T* here, const T* up, std::ptrdiff_t last, T* y,
                                      std::ptrdiff_t stride) {
      const T* const row[3] = {down, here, up};
      for (std::ptrdiff_t i = 3; i < last; i += P::size) {
        Pack centre, p, q, d[directions];
        P::load(here + i, centre);
        const Pack twice = centre + centre;
#pragma GCC unroll 4
        for (int a = 0; a < directions; ++a) {
          P::load(row[1 + step[a].j] + i + 3 * step[a].i, p);
          P::load(row[1 - step[a].j] + i - 3 * step[a].i, q);
          d[a] = p + q - twice;
        }
#pragma GCC unroll 4
        for (int a = 0; a < directions; ++a) {
          Pack sum = m[a][0] * d[0];
#pragma GCC unroll 4
          for (int b = 1; b < directions; ++b) sum += m[a][b] * d[b];
          P::store(sum, y + a * stride + i);
        }
      }
    }

    // out <- the transposed differences of y on a row of `size` numbers.
    DF_INLINE static void set_row(const T* down, const T* here, const T* up, std::ptrdiff_t stride,
                                  std::ptrdiff_t size, T* out) {
      const T* const row[3] = {down, here, up};
      for (std::ptrdiff_t i = 0; i < size; i += P::size) {
        Pack p, q, sum;
        P::load(here + i, p);
        P::load(here + stride + i, q);
        Pack own = p + q;
        P::load(here + 2 * stride + i, p);
        if constexpr (quad) {
          P::load(here + 3 * stride + i, q);
          own += p + q;
        } else {
          own += p;
        }
#pragma GCC unroll 4
        for (int k = 0; k < directions; ++k) {
          const int a = order[k];
          P::load(row[1 + step[a].j] + a * stride + i + 3 * step[a].i, p);
          P::load(row[1 - step[a].j] + a * stride + i - 3 * step[a].i, q);
          if (k == 0)
            sum = p + q;
          else
            sum += p + q;
        }
        sum -= own + own;
        P::store(sum, out + i);
      }
    }

    DF_INLINE static void run(int n, const T* c, T scale, const T* x, const T* weight, T* closed,
                              T* storage) {
      T m[directions][directions];
      for (int a = 0; a < directions; ++a)
        for (int b = 0; b < directions; ++b) m[a][b] = scale * c[4 * a + b];
      const Moments<T, Bytes> moments{moments_stride(n), storage};
      moments.clear(directions, -1, 0, 3 * (n + 2));
      moments.clear(directions, 0, 0, 3 * (n + 2));
      const T* at = x;  // row j
      std::ptrdiff_t size = 3 * std::ptrdiff_t(n + 1);
      for (int j = 0; j <= n; ++j, size -= shrink) {
        // The moments of row j + 1, if it has points inside the face.
        if (j + 1 <= (quad ? n - 1 : n - 2)) {
          const T* const here = at + size;
          T* const y = moments.row(j + 1, 0);
          const std::ptrdiff_t last = 3 * std::ptrdiff_t(quad ? n : n - 1 - j);
          set_moments(m, at, here, here + size - shrink, last, y, moments.stride);
          if (weight)
            for (int a = 0; a < directions; ++a)
              for (std::ptrdiff_t i = 3; i < last; ++i)
                y[a * moments.stride + i] *= weight[here - x + i];
          moments.clear(directions, j + 1, last, 6);
        } else {
          moments.clear(directions, j + 1, 0, quad ? 3 * (n + 2) : 12);
        }
        set_row(moments.row(j - 1, 0), moments.row(j, 0), moments.row(j + 1, 0), moments.stride,
                size, closed);
        closed += size;
        at += size;
      }
    }
  };
};

}  // namespace passes

// target lanes <- (rows)^T rows (lanes), scaled; storage holds 5 lanes.
template <class T>
void set_edge_pass(int n, const EdgeRingLanes& ring, const T* row, T scale, T* const* lane,
                   const T* weight, T* const* target, T* storage) {
  run_loop<passes::EdgePass, T>(n, &ring, row, scale, lane, weight, target, storage);
}

// closed <- (second differences)^T C (second differences) x over the interior points of a closed
// face. c is a symmetric matrix on the grid's directions (face_directions() in grid/ring.h), 3 x 3
// or 4 x 4 in rows of 4, scaled by `scale` and, if not null, by `weight` at each point, laid out as
// x. storage holds moments_size(n) numbers, zero on first use.
template <bool quad, class T>
void set_face_pass(int n, const T* c, T scale, const T* x, const T* weight, T* closed, T* storage) {
  run_loop<passes::FacePass<quad>::template Of, T>(n, c, scale, x, weight, closed, storage);
}

}  // namespace fairing
