// SPDX-License-Identifier: GPL-3.0-or-later
// The inner loops of K's action without a matrix: two one-ring passes, y = C d with the divided
// differences d, then the transposed differences of y. At a vertex and along a control edge all
// points have one stencil. Inside a control face they have one matrix C on the second differences
// d_a along the grid's directions a,
//
//   d_a(i) = x(i + a) + x(i - a) - 2 x(i),   (K x)(i) = sum_a y_a(i + a) + y_a(i - a) - 2 y_a(i).
//
// Tension's part is (L x)_i = sum_j w_ij (x_i - x_j) over the ring of i, with the weights of
// stencil/membrane.h. They are the same from both ends of an edge, so each point's row is gathered
// from its own ring.
//
// Rows have three interleaved coordinates, in packs (base/simd.h). Inside a face, what the last
// pack writes beyond a row is overwritten by the next row, or lies in the extra room at the end of each
// buffer. The order of every sum is fixed, because it determines the result's bits.
#pragma once

#include <algorithm>

#include "base/simd.h"
#include "grid/ring.h"

namespace fairing {

namespace passes {

// Calls body(Packs, i) for the numbers from i on, in whole packs, then in single numbers.
template <class T, int Bytes, class Body>
DF_INLINE void along(std::size_t numbers, const Body& body) {
  using P = Packs<T, Bytes>;
  std::size_t i = 0;
  for (; i + P::size <= numbers; i += P::size) body(P{}, i);
  for (; i < numbers; ++i) body(Packs<T, int(sizeof(T))>{}, i);
}

// For a run whose points have the same rows, with `numbers` numbers, three a point.
template <class T, int Bytes>
struct RunPass {
  // target[s] += the transposed rows of m_c[i] = sum_s row[3 s + c] (at[s + 1][i] - at[0][i]),
  // times `scale` and, if not null, a weight of each point.
  DF_INLINE static void run(std::size_t numbers, std::size_t size, const T* row, T scale,
                            const T* const* at, const T* weight, T* const* target, T* moments) {
    T* const m[3] = {moments, moments + numbers, moments + 2 * numbers};
    along<T, Bytes>(numbers, [&]<class P>(P, std::size_t i) __attribute__((always_inline)) {
      typename P::Pack own, d, sum[3] = {};
      P::load(at[0] + i, own);
      for (std::size_t s = 0; s < size; ++s) {
        P::load(at[s + 1] + i, d);
        d -= own;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += row[3 * s + c] * d;
      }
      for (std::size_t c = 0; c < 3; ++c) P::store(scale * sum[c], m[c] + i);
    });
    for (std::size_t i = 0; i < numbers && weight; ++i)
      for (T* moment : m) moment[i] *= weight[i / 3];
    const auto add = [&](const T* column, T* to) __attribute__((always_inline)) {
      along<T, Bytes>(numbers, [&]<class P>(P, std::size_t i) __attribute__((always_inline)) {
        typename P::Pack sum, moment;
        P::load(to + i, sum);
        for (std::size_t c = 0; c < 3; ++c) {
          P::load(m[c] + i, moment);
          sum += column[c] * moment;
        }
        P::store(sum, to + i);
      });
    };
    T total[3] = {};
    for (std::size_t s = 0; s < size; ++s) {
      add(row + 3 * s, target[s + 1]);
      for (std::size_t c = 0; c < 3; ++c) total[c] -= row[3 * s + c];
    }
    add(total, target[0]);
  }
};

template <class T, int Bytes>
struct MembranePass {
  DF_INLINE static void run(std::size_t numbers, std::size_t size, const double* weight,
                            const T* const* at, T* out) {
    along<T, Bytes>(numbers, [&]<class P>(P, std::size_t i) __attribute__((always_inline)) {
      typename P::Pack own, other, sum = {};
      P::load(at[0] + i, own);
      for (std::size_t s = 0; s < size; ++s) {
        P::load(at[s + 1] + i, other);
        sum += T(weight[s]) * (own - other);
      }
      P::load(out + i, other);
      P::store(other + sum, out + i);
    });
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

// closed <- (second differences)^T C (second differences) x over the interior points of a closed
// face. c is a symmetric matrix on the grid's directions (face_directions() in grid/ring.h), 3 x 3
// or 4 x 4 in rows of 4, scaled by `scale` and, if not null, by `weight` at each point, laid out as
// x. storage holds moments_size(n) numbers, zero on first use.
template <bool quad, class T>
void set_face_pass(int n, const T* c, T scale, const T* x, const T* weight, T* closed, T* storage) {
  run_loop<passes::FacePass<quad>::template Of, T>(n, c, scale, x, weight, closed, storage);
}

}  // namespace fairing
