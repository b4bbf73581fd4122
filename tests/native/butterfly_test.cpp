// SPDX-License-Identifier: GPL-3.0-or-later
// The yardstick itself.
#include "butterfly.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "curvature/total_curvature.h"
#include "grid/grid_level.h"
#include "meshes.h"

namespace fairing::test {
namespace {

ControlMesh control(const OwnedPolygonMesh& mesh) { return make_control_mesh(mesh.view(), {}); }

OwnedPolygonMesh triangle_torus(int around, int across) {
  return triangulated(torus(around, across));
}

TEST(Butterfly, KeepsControlVerticesAndConstants) {
  for (const OwnedPolygonMesh& mesh :
       {tetrahedron(), octahedron(), icosahedron(), cube_triangles()}) {
    const ControlMesh triangles = control(mesh);
    const std::vector<double> x = butterfly(triangles, 3);
    ASSERT_EQ(x.size(), 3 * GridLevel(triangles, 3).size());
    for (std::size_t v = 0; v < triangles.positions.size(); ++v)
      for (std::size_t a = 0; a < 3; ++a)
        EXPECT_EQ(x[3 * v + a], triangles.positions[v][Eigen::Index(a)]);
    ControlMesh point = triangles;
    for (Vec3& p : point.positions) p = Vec3(1, -2, 0.5);
    const std::vector<double> same = butterfly(point, 2);
    for (std::size_t i = 0; i < same.size(); i += 3)
      EXPECT_LT((Eigen::Map<const Vec3>(&same[i]) - Vec3(1, -2, 0.5)).norm(), 1e-14);
  }
}

TEST(Butterfly, IsOfFourthOrderOnRegularMeshes) {
  // On a periodic regular grid the first midpoint along u is the parameter's own.
  const auto error = [](int around) {
    ControlMesh mesh = control(triangle_torus(around, around));
    const double step = 2 * std::numbers::pi / around;
    for (int i = 0; i < around; ++i)
      for (int j = 0; j < around; ++j)
        mesh.positions[std::size_t(i * around + j)] =
            Vec3(std::sin(step * i), std::cos(step * (i + j)), 0);
    const GridLevel fine(mesh, 1);
    const std::vector<double> x = butterfly(mesh, 1);
    double worst = 0;
    for (Index e = 0; e < Index(mesh.edges.size()); ++e) {
      const auto [a, b] = mesh.edges[std::size_t(e)].vertex;
      double u[2] = {double(a / around), double(b / around)},
             v[2] = {double(a % around), double(b % around)};
      if (std::abs(u[1] - u[0]) > 1) u[u[0] < u[1] ? 0 : 1] += around;
      if (std::abs(v[1] - v[0]) > 1) v[v[0] < v[1] ? 0 : 1] += around;
      const double p = step * (u[0] + u[1]) / 2, q = step * (v[0] + v[1]) / 2;
      const double* y = x.data() + 3 * std::size_t(fine.edge_point(e, 1));
      worst = std::max({worst, std::abs(y[0] - std::sin(p)), std::abs(y[1] - std::cos(p + q))});
    }
    return worst;
  };
  EXPECT_NEAR(std::log2(error(16) / error(32)), 4, 0.1);
}

TEST(Butterfly, RoundsTheIcosahedron) {
  const ControlMesh mesh = control(icosahedron());
  const std::vector<double> x = butterfly(mesh, 4);
  for (std::size_t i = 0; i < x.size(); i += 3)
    EXPECT_NEAR(std::hypot(x[i], x[i + 1], x[i + 2]), 1, 0.05);
  Workers workers(1);
  EXPECT_NEAR(total_curvature(GridLevel(mesh, 4), workers, x.data()) / (8 * std::numbers::pi), 1.19,
              0.02);
}

}  // namespace
}  // namespace fairing::test
