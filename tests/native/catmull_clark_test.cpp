// SPDX-License-Identifier: GPL-3.0-or-later
// The subdivision surface: its points against limit positions, and those of fewer steps.
#include "mesh/catmull_clark.h"

#include <gtest/gtest.h>

#include "base/points.h"

namespace fairing::test {
namespace {

// A house without its floor: quads, triangles, pentagons and a border.
OwnedPolygonMesh house() {
  return {
      {0, 0, 0, 2, 0, 0, 2, 3, 0, 0, 3, 0, 0, 0, 2, 2, 0, 2, 2, 3, 2, 0, 3, 2, 1, 0, 3, 1, 3, 3},
      {0, 1, 5, 8, 4, 2, 3, 7, 9, 6, 1, 2, 6, 5, 3, 0, 4, 7, 5, 6, 9, 8, 4, 8, 9, 4, 9, 7},
      {0, 5, 10, 14, 18, 22, 25, 28}};
}

void expect_near(const Vec3& a, const Vec3& b) { EXPECT_LT((a - b).norm(), 1e-13); }

TEST(CatmullClark, LimitsDoNotDependOnTheSteps) {
  const OwnedPolygonMesh mesh = house();
  FeatureOptions features;
  features.crease_edges = {{0, 4}, {4, 8}, {8, 5}, {5, 1}};
  const ControlMesh control = make_control_mesh(mesh.view(), features);
  for (const double sharpness : {0.0, 0.4, 1.7}) {
    const SharpRules rules(control, {}, {{{{5, 6}, {6, 9}}, {sharpness, sharpness}}, {}});
    const CatmullClark one(mesh.view(), control, rules, 1);
    const std::vector<double> at = one.vertex_limits(mesh.coordinates);
    const CatmullClark coarse(mesh.view(), control, rules, 3), fine(mesh.view(), control, rules, 5);
    const Array<double> few = coarse.limits(mesh.coordinates), many = fine.limits(mesh.coordinates);
    for (Index v = 0; v < 10; ++v) expect_near(point_at(few, v), point_at(at, v));
    for (Index f = 0; f + 1 < Index(mesh.offsets.size()); ++f)
      for (Index k = coarse.corners(f); k < coarse.corners(f + 1); ++k)
        for (int a = 0; a <= 4; ++a)
          for (int b = 0; b <= 4; ++b)
            expect_near(point_at(few, coarse.point(f, k, a, b)),
                        point_at(many, fine.point(f, k, 4 * a, 4 * b)));
  }
}

}  // namespace
}  // namespace fairing::test
