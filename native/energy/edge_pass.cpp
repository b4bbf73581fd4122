// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/edge_pass.h"

#include "energy/dispatch.h"

namespace fairing {
namespace {

template <int ring, class T>
inline void pass(std::size_t count, const T* const* in, const T* __restrict own, const T* rows, T scale,
                 T* __restrict z, T* __restrict centre) {
  T g[3][ring];
  const T* p[ring];
  for (int j = 0; j < ring; ++j) {
    p[j] = in[j];
    for (int c = 0; c < 3; ++c) g[c][j] = rows[8 * c + j];
  }
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC ivdep
#endif
  for (std::size_t i = 0; i < count; ++i) {
    T y0 = 0, y1 = 0, y2 = 0, sum = 0;
    for (int j = 0; j < ring; ++j) {
      const T d = p[j][i] - own[i];
      y0 += g[0][j] * d;
      y1 += g[1][j] * d;
      y2 += g[2][j] * d;
    }
    y0 *= scale;
    y1 *= scale;
    y2 *= scale;
    for (int j = 0; j < ring; ++j) {
      const T part = g[0][j] * y0 + g[1][j] * y1 + g[2][j] * y2;
      z[std::size_t(j) * count + i] = part;
      sum += part;
    }
    centre[i] -= sum;
  }
}

template <class T>
inline void choose(int ring, std::size_t count, const T* const* in, const T* own, const T* rows, T scale,
                   T* z, T* centre) {
  switch (ring) {
    case 4: return pass<4>(count, in, own, rows, scale, z, centre);
    case 5: return pass<5>(count, in, own, rows, scale, z, centre);
    case 6: return pass<6>(count, in, own, rows, scale, z, centre);
    case 7: return pass<7>(count, in, own, rows, scale, z, centre);
    default: return pass<8>(count, in, own, rows, scale, z, centre);
  }
}

}  // namespace

FAIRING_WIDE void edge_pass(int ring, std::size_t count, const float* const* in, const float* own,
                            const float* rows, float scale, float* z, float* centre) {
  choose(ring, count, in, own, rows, scale, z, centre);
}

FAIRING_WIDE void edge_pass(int ring, std::size_t count, const double* const* in, const double* own,
                            const double* rows, double scale, double* z, double* centre) {
  choose(ring, count, in, own, rows, scale, z, centre);
}

}  // namespace fairing
