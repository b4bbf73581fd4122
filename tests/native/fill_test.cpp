// SPDX-License-Identifier: GPL-3.0-or-later
// Holes, their loops and their triangles.
#include "mesh/fill/fill.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "meshes.h"

namespace fairing::test {
namespace {

SpacePolygon circle(std::size_t corners) {
  SpacePolygon polygon;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::acos(-1.0) * double(i) / double(corners);
    polygon.points.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  polygon.normals.assign(corners, Vec3::UnitZ());
  polygon.may_join = [](std::size_t, std::size_t) { return true; };
  return polygon;
}

// All turn the same way, and their areas are the polygon's.
void expect_covered(const SpacePolygon& polygon, double area) {
  const std::vector<Triangle> found = triangulate(polygon);
  ASSERT_EQ(found.size(), polygon.points.size() - 2);
  double sum = 0;
  for (const Triangle& t : found) {
    const Vec3& a = polygon.points[std::size_t(t[0])];
    const Vec3 n =
        (polygon.points[std::size_t(t[1])] - a).cross(polygon.points[std::size_t(t[2])] - a);
    EXPECT_GE(n.z(), 0);
    sum += n.norm() / 2;
  }
  EXPECT_NEAR(sum, area, 1e-9);
}

TEST(Fill, TrianglesOverFlatLoopsOfAnyLength) {
  for (const std::size_t corners : {3, 4, 50, 400, 401, 1000, 5000}) {
    const double n = double(corners);
    expect_covered(circle(corners), n / 2 * std::sin(2 * std::acos(-1.0) / n));
  }
}

TEST(Fill, TrianglesInAConcaveLoop) {
  SpacePolygon polygon;
  for (const auto& [x, y] :
       {std::pair{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}})
    polygon.points.emplace_back(x, y, 0);
  polygon.normals.assign(8, Vec3::UnitZ());
  polygon.may_join = [](std::size_t, std::size_t) { return true; };
  expect_covered(polygon, 7);
}

TEST(Fill, ChordsThatMayNotBe) {
  SpacePolygon polygon = circle(4);
  polygon.may_join = [](std::size_t low, std::size_t) { return low == 1; };
  const std::vector<Triangle> found = triangulate(polygon);
  ASSERT_EQ(found.size(), 2u);
  for (const Triangle& t : found) EXPECT_TRUE(t[0] == 1 || t[1] == 1 || t[2] == 1);
  polygon.may_join = [](std::size_t, std::size_t) { return false; };
  EXPECT_TRUE(triangulate(polygon).empty());
}

// A comb of long teeth on a saddle: the mean of a point's neighbours often lies beyond the rim.
TEST(Fill, RefinedTrianglesDoNotTurnOverTheRim) {
  SpacePolygon polygon;
  std::vector<std::pair<double, double>> corners;
  for (int tooth = 0; tooth < 4; ++tooth) {
    const double x = 2 * tooth;
    for (int k = 0; k < 8; ++k) corners.emplace_back(x, 1 + 0.5 * k);
    for (int k = 0; k < 8; ++k) corners.emplace_back(x + 0.5, 4.5 - 0.5 * k);
  }
  corners.emplace_back(6.5, 0);
  corners.emplace_back(0, 0);
  std::reverse(corners.begin(), corners.end());
  for (const auto& [x, y] : corners) {
    polygon.points.emplace_back(x, y, 0.05 * (x * x - y * y));
    polygon.normals.push_back(Vec3(-0.1 * x, 0.1 * y, 1).normalized());
  }
  polygon.may_join = [](std::size_t, std::size_t) { return true; };
  const std::vector<double> lengths(polygon.points.size(), 0.4);
  Patch patch{polygon.points, lengths, Index(polygon.points.size()), triangulate(polygon),
              polygon.normals};
  refine(patch, [](Index, Index) { return false; }, Relaxation::taut);
  EXPECT_GT(patch.points.size(), polygon.points.size() + 20);
  for (const Triangle& t : patch.triangles) {
    const Vec3& a = patch.points[std::size_t(t[0])];
    const Vec3 n = (patch.points[std::size_t(t[1])] - a).cross(patch.points[std::size_t(t[2])] - a);
    EXPECT_GT(n.z(), 0.3 * n.norm());
  }
}

}  // namespace
}  // namespace fairing::test
