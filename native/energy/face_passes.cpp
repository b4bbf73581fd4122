// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/face_passes.h"

#include <algorithm>

#include "energy/dispatch.h"
#include "lattice/lattice.h"

namespace fairing {
namespace {

// Three rolling rows of `directions` moments each, padded by one point on either side.
template <class T>
class Moments {
 public:
  Moments(int n, int directions, T* storage)
      : stride_(3 * std::ptrdiff_t(n + 3)), directions_(directions), data_(storage) {
    std::fill(data_, data_ + 3 * directions_ * stride_, T(0));
  }

  // Row j of direction a; element 0 is the point i = 0.
  T* row(int j, int a) { return data_ + (((j + 3) % 3) * directions_ + a) * stride_ + 3; }

  // Forgets what an earlier row left behind `first` (in points).
  void clear_from(int j, int first, int count) {
    for (int a = 0; a < directions_; ++a)
      std::fill(row(j, a) + 3 * first, row(j, a) + 3 * (first + count), T(0));
  }

 private:
  std::ptrdiff_t stride_, directions_;
  T* data_;
};

template <class T>
inline void triangle_pass(int n, const T* c, T scale, const T* x, T* closed, T* storage) {
  const T c00 = scale * c[0], c01 = scale * c[1], c02 = scale * c[2], c11 = scale * c[5], c12 = scale * c[6],
          c22 = scale * c[10];
  const std::size_t un = std::size_t(n);
  Moments<T> moments(n, 3, storage);
  const auto row = [&](const T* base, int j) { return base + 3 * closed_row(false, un, std::size_t(j)); };

  const auto fill = [&](int j) {
    const int width = n - 1 - j;  // interior points of row j
    const T *at = row(x, j), *up = row(x, j + 1), *down = row(x, j - 1);
    T* __restrict a = moments.row(j, 0), * __restrict b = moments.row(j, 1), * __restrict d = moments.row(j, 2);
    for (std::ptrdiff_t i = 3; i < 3 + 3 * width; ++i) {
      const T twice = 2 * at[i];
      const T da = at[i + 3] + at[i - 3] - twice, db = up[i] + down[i] - twice,
              dc = up[i - 3] + down[i + 3] - twice;
      a[i] = c00 * da + c01 * db + c02 * dc;
      b[i] = c01 * da + c11 * db + c12 * dc;
      d[i] = c02 * da + c12 * db + c22 * dc;
    }
    moments.clear_from(j, 1 + width, 3);
  };

  for (int j = 0; j <= n; ++j) {
    if (j + 1 <= n - 2)
      fill(j + 1);
    else
      moments.clear_from(j + 1, 0, std::min(4, n + 1));
    T* __restrict out = closed + 3 * closed_row(false, un, std::size_t(j));
    const T *a = moments.row(j, 0), *b = moments.row(j, 1), *d = moments.row(j, 2);
    const T *b_up = moments.row(j + 1, 1), *d_up = moments.row(j + 1, 2);
    const T *b_down = moments.row(j - 1, 1), *d_down = moments.row(j - 1, 2);
    for (std::ptrdiff_t i = 0; i < 3 * (n + 1 - j); ++i)
      out[i] +=
          a[i + 3] + a[i - 3] + b_up[i] + b_down[i] + d_up[i - 3] + d_down[i + 3] - 2 * (a[i] + b[i] + d[i]);
  }
}

template <class T>
inline void quad_pass(int n, const T* c, T scale, const T* x, T* closed, T* storage) {
  T m[4][4];
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) m[a][b] = scale * c[4 * a + b];
  Moments<T> moments(n, 4, storage);
  const std::ptrdiff_t stride = 3 * std::ptrdiff_t(n + 1);

  const auto fill = [&](int j) {
    const T *at = x + j * stride, *up = at + stride, *down = at - stride;
    T *__restrict s = moments.row(j, 0), *__restrict d = moments.row(j, 1), *__restrict t = moments.row(j, 2),
                 *__restrict e = moments.row(j, 3);
    for (std::ptrdiff_t i = 3; i < 3 * n; ++i) {
      const T twice = 2 * at[i];
      const T ds = at[i + 3] + at[i - 3] - twice, dd = up[i + 3] + down[i - 3] - twice,
              dt = up[i] + down[i] - twice, de = up[i - 3] + down[i + 3] - twice;
      s[i] = m[0][0] * ds + m[0][1] * dd + m[0][2] * dt + m[0][3] * de;
      d[i] = m[1][0] * ds + m[1][1] * dd + m[1][2] * dt + m[1][3] * de;
      t[i] = m[2][0] * ds + m[2][1] * dd + m[2][2] * dt + m[2][3] * de;
      e[i] = m[3][0] * ds + m[3][1] * dd + m[3][2] * dt + m[3][3] * de;
    }
  };

  for (int j = 0; j <= n; ++j) {
    if (j + 1 <= n - 1)
      fill(j + 1);
    else
      moments.clear_from(j + 1, 0, n + 1);
    T* __restrict out = closed + j * stride;
    const T *s = moments.row(j, 0), *d = moments.row(j, 1), *t = moments.row(j, 2), *e = moments.row(j, 3);
    const T *d_up = moments.row(j + 1, 1), *t_up = moments.row(j + 1, 2), *e_up = moments.row(j + 1, 3);
    const T *d_down = moments.row(j - 1, 1), *t_down = moments.row(j - 1, 2), *e_down = moments.row(j - 1, 3);
    for (std::ptrdiff_t i = 0; i < stride; ++i)
      out[i] += s[i + 3] + s[i - 3] + t_up[i] + t_down[i] + d_up[i + 3] + d_down[i - 3] + e_up[i - 3] +
                e_down[i + 3] - 2 * (s[i] + d[i] + t[i] + e[i]);
  }
}

}  // namespace

FAIRING_WIDE void add_triangle_pass(int n, const float* c, float scale, const float* x, float* closed,
                                    float* scratch) {
  triangle_pass(n, c, scale, x, closed, scratch);
}
FAIRING_WIDE void add_triangle_pass(int n, const double* c, double scale, const double* x, double* closed,
                                    double* scratch) {
  triangle_pass(n, c, scale, x, closed, scratch);
}
FAIRING_WIDE void add_quad_pass(int n, const float* c, float scale, const float* x, float* closed,
                                float* scratch) {
  quad_pass(n, c, scale, x, closed, scratch);
}
FAIRING_WIDE void add_quad_pass(int n, const double* c, double scale, const double* x, double* closed,
                                double* scratch) {
  quad_pass(n, c, scale, x, closed, scratch);
}

}  // namespace fairing
