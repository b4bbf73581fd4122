// SPDX-License-Identifier: GPL-3.0-or-later
// The numbering of a level, and the control polyhedron on it.
#include <gtest/gtest.h>

#include "grid/linear.h"
#include "level_settings.h"

namespace fairing::test {
namespace {

TEST(GridLevel, NumbersEveryPointOnce) {
  on_all(3, [](const Setting& s, Workers&) {
    std::vector<int> seen(s.grid.size(), 0);
    for (const Cell& cell : cells(s.grid))
      for (const Index p : cell)
        if (p >= 0) ++seen.at(std::size_t(p));
    for (std::size_t p = 0; p < seen.size(); ++p)
      EXPECT_EQ(seen[p] > 0,
                p >= std::size_t(s.mesh.vertex_count()) || !s.mesh.ring(Index(p)).empty())
          << p;
  });
}

TEST(GridLevel, LiesOnTheControlPolyhedron) {
  on_all(3, [](const Setting& s, Workers&) {
    Points x(Eigen::Index(s.grid.size()), 3);
    refine_linearly(s.grid, s.mesh.positions, x.data());
    const int n = s.grid.n();
    for (Index f = 0; f < Index(s.mesh.faces.size()); ++f) {
      const Face& face = s.mesh.faces[std::size_t(f)];
      const auto corner = [&](std::size_t c) {
        return s.mesh.positions[std::size_t(face.vertex[c])];
      };
      for (int side = 0; side < face.size; ++side)
        for (int k = 0; k <= n; ++k) {
          const double t = double(k) / n;
          const auto from = std::size_t(side), to = std::size_t((side + 1) % face.size);
          const Index p = s.grid.face_point(f, closed_point(face.quad(), n, side, k, 0));
          EXPECT_LT((x.row(p).transpose() - (1 - t) * corner(from) - t * corner(to)).norm(), 1e-14);
          EXPECT_EQ(p, s.grid.side_point(s.mesh.sides[std::size_t(face.first_side + side)], k));
        }
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= (face.quad() ? n : n - j); ++i) {
          const double u = double(i) / n, v = double(j) / n;
          const Vec3 expected = face.quad()
                                    ? Vec3((1 - u) * (1 - v) * corner(0) + u * (1 - v) * corner(1) +
                                           u * v * corner(2) + (1 - u) * v * corner(3))
                                    : Vec3((1 - u - v) * corner(0) + u * corner(1) + v * corner(2));
          EXPECT_LT((x.row(s.grid.face_point(f, i, j)).transpose() - expected).norm(), 1e-14);
        }
    }
  });
}

}  // namespace
}  // namespace fairing::test
