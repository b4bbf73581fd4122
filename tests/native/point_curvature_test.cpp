// SPDX-License-Identifier: GPL-3.0-or-later
// One ring at a time: the second fundamental form, the divided differences and angles behind it.
#include "curvature/point_curvature.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "stencil/angle.h"

namespace fairing::test {
namespace {

constexpr double pi = std::numbers::pi;

TEST(PointCurvature, StaysExactWhereTheAreaHasItsFloor) {
  // A star: triangles obtuse at its near points, so that the circumcentric area is negative.
  const double radius = 1.5;
  SurfaceChart chart;
  for (const bool cells : {false, true}) {  // near points as the far corners of quads, too
    std::vector<Vec3> offset;
    std::vector<std::uint8_t> far;
    for (int j = 0; j < 10; ++j) {
      const double turn = 2 * pi * j / 10, reach = j % 2 ? 0.05 : 0.7;
      offset.push_back(radius * Vec3(std::sin(reach) * std::cos(turn),
                                     std::sin(reach) * std::sin(turn), std::cos(reach) - 1));
      far.push_back(cells && j % 2);
    }
    double barycentric = 0;
    for (std::size_t j = 0; j < 10 && !cells; ++j)
      barycentric += offset[j].cross(offset[(j + 1) % 10]).norm() / 6;
    const PointCurvature c = point_curvature({offset, far}, chart);
    EXPECT_NEAR(c.trace, -2 / radius, 1e-12);
    EXPECT_NEAR(std::hypot(c.trace_free[0], c.trace_free[1]), 0, 1e-11);
    EXPECT_LT((c.normal - Vec3::UnitZ()).norm(), 1e-13);
    EXPECT_NEAR(c.area, cells ? c.area : 0.1 * barycentric, 1e-14);
  }
}

// Nothing where the ring has shrunk to its point, but no end of it where it is not finite.
TEST(PointCurvature, IsInfiniteOfARingThatHasBurst) {
  SurfaceChart chart;
  const std::vector<std::uint8_t> far(4, 0);
  const auto of = [&](double x) {
    const std::vector<Vec3> offset{{x, 0, 0}, {0, 1, 0}, {-1, 0, 0.1}, {0, -1, 0}};
    return point_curvature({offset, far}, chart);
  };
  for (const double x : {double(NAN), double(INFINITY), 1e160, 1e300}) {
    const PointCurvature point = of(x);
    EXPECT_TRUE(std::isinf(point.area * point.density())) << x;
    EXPECT_FALSE(point.has_rows()) << x;
  }
  EXPECT_EQ(of(0).area * of(0).density(), 0);
  EXPECT_TRUE(of(1).has_rows() && of(1e6).has_rows());
}

TEST(PointCurvature, KnowsTheDirectionsOfACylinder) {
  // Quads along and around; the first neighbour lies along the axis, then half-way between, then
  // around.
  const double radius = 2, step = 0.01;
  const auto ring = [&](int first) {
    std::vector<Vec3> offset;
    for (int j = first; j < first + 8; ++j) {
      const double along[] = {1, 1, 0, -1, -1, -1, 0, 1}, around[] = {0, 1, 1, 1, 0, -1, -1, -1};
      const double angle = step * around[j % 8] / radius;
      offset.push_back(
          {radius * (std::cos(angle) - 1), -radius * std::sin(angle), step * along[j % 8]});
    }
    return offset;
  };
  SurfaceChart chart;
  for (int first = 0; first < 3; ++first) {
    std::vector<std::uint8_t> far;
    for (int j = 0; j < 8; ++j) far.push_back((j + first) % 2);
    const PointCurvature c = point_curvature({ring(first), far}, chart);
    const double part = 1 / (radius * std::numbers::sqrt2);
    EXPECT_NEAR(c.trace, -1 / radius, 1e-5);
    EXPECT_NEAR(c.trace_free[0], first == 0 ? part : first == 1 ? 0 : -part, 1e-5) << first;
    EXPECT_NEAR(std::abs(c.trace_free[1]), first == 1 ? part : 0, 1e-5) << first;
    EXPECT_NEAR(std::abs(c.normal.x()), 1, 1e-6);
    EXPECT_NEAR(c.area, step * step, 1e-6 * step);
    EXPECT_NEAR(c.density(), 1 / (radius * radius), 1e-5);
    EXPECT_NEAR(chart.ring[0].y(), 0, 1e-15);
  }
}

TEST(Angle, AgreesWithTheLibrary) {
  for (int k = 0; k <= 1000; ++k) {
    const double angle = pi * k / 1000;
    EXPECT_NEAR(angle_of(2.5 * std::sin(angle), 2.5 * std::cos(angle), 2.5), angle, 2e-14) << k;
  }
  for (int k = -300; k <= 300; ++k) {
    double cosine, sine;
    small_turn(0.01 * k, cosine, sine);
    EXPECT_NEAR(cosine, std::cos(0.01 * k), 3e-16);
    EXPECT_NEAR(sine, std::sin(0.01 * k), 3e-16);
  }
}

}  // namespace
}  // namespace fairing::test
