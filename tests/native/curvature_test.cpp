// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "fair/fair.h"
#include "meshes.h"

namespace fairing::test {
namespace {

double farthest_from_sphere(const FairResult& result) {
  double most = 0;
  for (std::size_t i = 0; i < result.vertices.size(); i += 3)
    most = std::max(most, std::abs(Eigen::Map<const Vec3>(result.vertices.data() + i).norm() - 1));
  return most;
}

TEST(TotalCurvature, MakesSpheresOfInscribedMeshes) {
  FairOptions options;
  options.energy = Energy::total_curvature;
  options.levels = 3;
  options.threads = 1;
  OwnedPolygonMesh mesh = icosahedron();
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += 3) {
    Eigen::Map<Vec3> p(mesh.coordinates.data() + i);
    p.normalize();
  }
  Monitor monitor;
  EXPECT_LT(farthest_from_sphere(fair(mesh.view(), options, monitor)), 1e-5);
}

}  // namespace
}  // namespace fairing::test
