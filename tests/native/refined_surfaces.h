// SPDX-License-Identifier: GPL-3.0-or-later
// Control quads over grids of points, refined by what `at` says: no solver takes part.
#pragma once

#include <cstdint>
#include <vector>

#include "splines/lattice.h"

namespace fairing::test {

struct Refined {
  int levels;
  std::vector<double> vertices;
  std::vector<std::int32_t> triangles, quads;

  RefinedSurface view() const { return {levels, vertices, triangles, quads, {}}; }
};

// columns x 1 quads over [0, columns] x [0, 1].
template <class At>
Refined strip(int columns, int levels, At&& at) {
  Refined out{levels, {}, {}, {}};
  const int n = 1 << levels, width = columns * n + 1;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i < width; ++i)
      for (const double x : at(double(i) / n, double(j) / n)) out.vertices.push_back(x);
  for (int f = 0; f < columns; ++f)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int first = j * width + f * n + i;
        for (const int p : {first, first + 1, first + width + 1, first + width})
          out.quads.push_back(p);
      }
  return out;
}

}  // namespace fairing::test
