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

TEST(CatmullClark, VerticesWithoutFacesStay) {
  OwnedPolygonMesh mesh = house();
  mesh.coordinates.insert(mesh.coordinates.end(), {5, 6, 7});
  const ControlMesh control = make_control_mesh(mesh.view(), {});
  const SharpRules rules(control, {}, {{}, std::vector<double>(11, 0.7)});
  const CatmullClark subdivided(mesh.view(), control, rules, 1);
  EXPECT_EQ(point_at(subdivided.vertex_limits(mesh.coordinates), 10), Vec3(5, 6, 7));
}

// Quads at the corners of a polygon share the middle of it and of its sides.
TEST(CatmullClark, QuadsMeet) {
  const OwnedPolygonMesh mesh = house();
  const ControlMesh control = make_control_mesh(mesh.view(), {});
  const CatmullClark subdivided(mesh.view(), control, SharpRules(control, {}, {}), 4);
  const int side = subdivided.pieces();
  ASSERT_EQ(side, 8);
  for (Index f = 0; f + 1 < Index(mesh.offsets.size()); ++f) {
    const Index first = subdivided.corners(f), last = subdivided.corners(f + 1);
    for (Index k = first; k < last; ++k) {
      const Index next = k + 1 < last ? k + 1 : first;
      EXPECT_EQ(subdivided.point(f, k, 0, 0), subdivided.vertex(k));
      for (int t = 0; t <= side; ++t)
        EXPECT_EQ(subdivided.point(f, k, side, t), subdivided.point(f, next, t, side));
    }
  }
}

}  // namespace
}  // namespace fairing::test
