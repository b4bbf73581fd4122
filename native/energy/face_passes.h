// SPDX-License-Identifier: GPL-3.0-or-later
// The two one-ring passes inside a control face: y = C d with the second differences d along the lattice directions,
// then the transposed differences of y. Rows of three interleaved coordinates, in packs: what a last
// pack writes too much is overwritten by the next row, or lies in the room of a block that buffers have at the end.
#pragma once

#include <algorithm>

#include "execution/wide.h"
#include "lattice/closed_face.h"

namespace fairing {

namespace passes {

constexpr std::ptrdiff_t blocks_of(std::ptrdiff_t numbers) {
  return (numbers + lane_block - 1) / lane_block * lane_block;
}

// Three rolling rows of four moments each, with zeros on either side of a row's interior points. Nobody ever writes
// before a row's points, so the storage, zero at first, keeps these zeros from face to face.
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
  DF_INLINE T* row(int j, int a) const { return data + (((j + 3) % 3) * 4 + a) * stride + lane_block; }
  // Zeros for `count` numbers from number `first`, rounded up.
  DF_INLINE void clear(int directions, int j, std::ptrdiff_t first, std::ptrdiff_t count) const {
    const typename P::Pack zero = {};
    for (int a = 0; a < directions; ++a)
      for (std::ptrdiff_t i = 0; i < count; i += P::size) P::store(zero, row(j, a) + first + i);
  }
};

// A row's moments times the factors of its points.
template <class T, std::size_t Directions>
DF_INLINE void weigh(const T* weight, std::ptrdiff_t first, std::ptrdiff_t last,
                     T* const (&moments)[Directions]) {
  for (T* moment : moments)
    for (std::ptrdiff_t i = first; i < last; ++i) moment[i] *= weight[i];
}

template <class T, int Bytes>
struct TrianglePass {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;

  DF_INLINE static void run(int n, const T* c, T scale, const T* x, const T* weight, T* closed, T* storage) {
    constexpr int block = P::size;
    const T c00 = scale * c[0], c01 = scale * c[1], c02 = scale * c[2], c11 = scale * c[5],
            c12 = scale * c[6], c22 = scale * c[10];
    const Moments<T, Bytes> moments{moments_stride(n), storage};
    moments.clear(3, -1, 0, 3 * (n + 2));
    moments.clear(3, 0, 0, 3 * (n + 2));
    const T* at = x;  // row j
    std::ptrdiff_t size = 3 * std::ptrdiff_t(n + 1);
    for (int j = 0; j <= n; ++j, size -= 3) {
      // moments of row j + 1
      if (j + 1 <= n - 2) {
        const T *here = at + size, *up = here + size - 3, *down = at;
        T *a = moments.row(j + 1, 0), *b = moments.row(j + 1, 1), *d = moments.row(j + 1, 2);
        const std::ptrdiff_t last = 3 * std::ptrdiff_t(n - 1 - j);
        for (std::ptrdiff_t i = 3; i < last; i += block) {
          Pack centre, p, q;
          P::load(here + i, centre);
          const Pack twice = centre + centre;
          P::load(here + i + 3, p);
          P::load(here + i - 3, q);
          const Pack da = p + q - twice;
          P::load(up + i, p);
          P::load(down + i, q);
          const Pack db = p + q - twice;
          P::load(up + i - 3, p);
          P::load(down + i + 3, q);
          const Pack dc = p + q - twice;
          P::store(c00 * da + c01 * db + c02 * dc, a + i);
          P::store(c01 * da + c11 * db + c12 * dc, b + i);
          P::store(c02 * da + c12 * db + c22 * dc, d + i);
        }
        if (weight) weigh(weight + (here - x), 3, last, {a, b, d});
        moments.clear(3, j + 1, last, 6);
      } else {
        moments.clear(3, j + 1, 0, 12);
      }
      const T *a = moments.row(j, 0), *b = moments.row(j, 1), *d = moments.row(j, 2);
      const T *b_up = moments.row(j + 1, 1), *d_up = moments.row(j + 1, 2);
      const T *b_down = moments.row(j - 1, 1), *d_down = moments.row(j - 1, 2);
      for (std::ptrdiff_t i = 0; i < size; i += block) {
        Pack p, q, r;
        P::load(a + i, p);
        P::load(b + i, q);
        P::load(d + i, r);
        const Pack own = p + q + r;
        P::load(a + i + 3, p);
        P::load(a + i - 3, q);
        Pack sum = p + q;
        P::load(b_up + i, p);
        P::load(b_down + i, q);
        sum += p + q;
        P::load(d_up + i - 3, p);
        P::load(d_down + i + 3, q);
        sum += p + q;
        sum -= own + own;
        P::store(sum, closed + i);
      }
      closed += size;
      at += size;
    }
  }
};

template <class T, int Bytes>
struct QuadPass {
  using P = Packs<T, Bytes>;
  using Pack = typename P::Pack;

  DF_INLINE static void run(int n, const T* c, T scale, const T* x, const T* weight, T* closed, T* storage) {
    constexpr int block = P::size;
    T m[4][4];
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) m[a][b] = scale * c[4 * a + b];
    const Moments<T, Bytes> moments{moments_stride(n), storage};
    moments.clear(4, -1, 0, 3 * (n + 2));
    moments.clear(4, 0, 0, 3 * (n + 2));
    const std::ptrdiff_t size = 3 * std::ptrdiff_t(n + 1);
    for (int j = 0; j <= n; ++j) {
      if (j + 1 <= n - 1) {
        const T *down = x + j * size, *here = down + size, *up = here + size;
        T *s = moments.row(j + 1, 0), *d = moments.row(j + 1, 1), *t = moments.row(j + 1, 2),
          *e = moments.row(j + 1, 3);
        for (std::ptrdiff_t i = 3; i < 3 * n; i += block) {
          Pack centre, p, q;
          P::load(here + i, centre);
          const Pack twice = centre + centre;
          P::load(here + i + 3, p);
          P::load(here + i - 3, q);
          const Pack ds = p + q - twice;
          P::load(up + i + 3, p);
          P::load(down + i - 3, q);
          const Pack dd = p + q - twice;
          P::load(up + i, p);
          P::load(down + i, q);
          const Pack dt = p + q - twice;
          P::load(up + i - 3, p);
          P::load(down + i + 3, q);
          const Pack de = p + q - twice;
          P::store(m[0][0] * ds + m[0][1] * dd + m[0][2] * dt + m[0][3] * de, s + i);
          P::store(m[1][0] * ds + m[1][1] * dd + m[1][2] * dt + m[1][3] * de, d + i);
          P::store(m[2][0] * ds + m[2][1] * dd + m[2][2] * dt + m[2][3] * de, t + i);
          P::store(m[3][0] * ds + m[3][1] * dd + m[3][2] * dt + m[3][3] * de, e + i);
        }
        if (weight) weigh(weight + (here - x), 3, 3 * n, {s, d, t, e});
        moments.clear(4, j + 1, 3 * n, 6);
      } else {
        moments.clear(4, j + 1, 0, 3 * (n + 2));
      }
      const T *s = moments.row(j, 0), *d = moments.row(j, 1), *t = moments.row(j, 2), *e = moments.row(j, 3);
      const T *d_up = moments.row(j + 1, 1), *t_up = moments.row(j + 1, 2), *e_up = moments.row(j + 1, 3);
      const T *d_down = moments.row(j - 1, 1), *t_down = moments.row(j - 1, 2),
              *e_down = moments.row(j - 1, 3);
      T* out = closed + j * size;
      for (std::ptrdiff_t i = 0; i < size; i += block) {
        Pack p, q, sum;
        P::load(s + i, p);
        P::load(d + i, q);
        Pack own = p + q;
        P::load(t + i, p);
        P::load(e + i, q);
        own += p + q;
        P::load(s + i + 3, p);
        P::load(s + i - 3, q);
        sum = p + q;
        P::load(t_up + i, p);
        P::load(t_down + i, q);
        sum += p + q;
        P::load(d_up + i + 3, p);
        P::load(d_down + i - 3, q);
        sum += p + q;
        P::load(e_up + i - 3, p);
        P::load(e_down + i + 3, q);
        sum += p + q;
        sum -= own + own;
        P::store(sum, out + i);
      }
    }
  }
};

}  // namespace passes

// closed <- (second differences)^T C (second differences) x over the interior points of a closed triangle; c is a
// symmetric 3 x 3 matrix in rows of 4, scaled by `scale`, and at each point by `weight`, laid out as x, where that is
// not null; storage holds moments_size(n) numbers, zero when
// it is first used.
template <class T>
void set_triangle_pass(int n, const T* c, T scale, const T* x, const T* weight, T* closed, T* storage) {
  run_loop<passes::TrianglePass, T>(n, c, scale, x, weight, closed, storage);
}

// The same for a quad: a 4 x 4 matrix on the directions s, s + t, t, t - s; moments_size(n) numbers.
template <class T>
void set_quad_pass(int n, const T* c, T scale, const T* x, const T* weight, T* closed, T* storage) {
  run_loop<passes::QuadPass, T>(n, c, scale, x, weight, closed, storage);
}

}  // namespace fairing
