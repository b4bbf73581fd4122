// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "curves/curve.h"

namespace fairing::test {
namespace {

using Points = std::vector<Vec3>;
constexpr double width = 75, length = 150, radius = 9;

// A rectangle with round corners, each of `chords`, and loops 0.7 from the ends of its sides.
Points outline(int chords, bool loops) {
  Points points;
  for (int corner = 0; corner < 4; ++corner) {
    const double x = width / 2 - radius, y = length / 2 - radius, quarter = std::numbers::pi / 2;
    const Vec3 centre(corner == 1 || corner == 2 ? -x : x, corner > 1 ? -y : y, 3);
    const auto at = [&](double angle) -> Vec3 {
      return centre + radius * Vec3(std::cos(angle), std::sin(angle), 0);
    };
    const double begin = corner * quarter;
    const Vec3 along(-std::sin(begin), std::cos(begin), 0);
    if (loops) points.push_back(at(begin) - 0.7 * along);
    for (int k = 0; k <= chords; ++k) points.push_back(at(begin + quarter * k / chords));
    if (loops) points.push_back(at(begin + quarter) + 0.7 * Vec3(-along.y(), along.x(), 0));
  }
  return points;
}

// Largest distances from the rectangle with round corners: of points of sides, of points of corners.
std::pair<double, double> departures(const Points& points) {
  double side = 0, corner = 0;
  for (const Vec3& p : points) {
    const double x = std::abs(p.x()) - width / 2 + radius,
                 y = std::abs(p.y()) - length / 2 + radius;
    const double off = std::abs((x > 0 && y > 0 ? std::hypot(x, y) : std::max(x, y)) - radius);
    (x > 0 && y > 0 ? corner : side) = std::max(x > 0 && y > 0 ? corner : side, off);
  }
  return {side, corner};
}

TEST(CurveLines, SidesOfARoundedRectangleAreStraightAndItsCornersRound) {
  for (const bool loops : {false, true})
    for (const int chords : {2, 3, 5})
      for (const double exponent : {0.0, 0.5, 1.0}) {
        const Points points = outline(chords, loops);
        const auto [side, corner] = departures(refine_chain(points, points, true, {8, exponent}));
        EXPECT_LT(side, 1e-12) << chords << " chords";
        EXPECT_LT(corner, 0.03 / chords) << chords << " chords, exponent " << exponent;
      }
}

TEST(CurveLines, ALineWithAFreeEndIsStraight) {
  Points points = outline(3, false);
  points = {points[3], points[4], points[5], points[6]};  // a side and two chords of an arc
  const std::vector<std::uint8_t> lines = tangent_lines(points, false);
  EXPECT_EQ(lines, std::vector<std::uint8_t>({1, 0, 0}));
}

TEST(CurveLines, RoundingInSinglePrecisionChangesNothing) {
  Points points = outline(3, true);
  for (Vec3& p : points) p = p.cast<float>().cast<double>();
  EXPECT_LT(departures(refine_chain(points, points, true, {8, 0.5})).first, 1e-5);
}

TEST(CurveLines, SmoothCurvesHaveNone) {
  for (const double spacing : {0.2, 0.35, 0.5, 0.8})
    for (double phase = 0; phase < spacing; phase += spacing / 16) {
      Points wave, ellipse;
      for (double t = phase; t < 12; t += spacing) wave.emplace_back(t, std::sin(t), 0);
      for (double t = phase; t < 6; t += spacing)
        ellipse.emplace_back(3 * std::cos(t), std::sin(t), 0);
      for (const Points& points : {wave, ellipse}) {
        const std::vector<std::uint8_t> lines = tangent_lines(points, false);
        EXPECT_EQ(std::count(lines.begin(), lines.end(), 1), 0) << spacing << ' ' << phase;
      }
    }
}

TEST(CurveLines, ASquareWithCutCornersHasNone) {
  for (const double cut : {0.1, 0.3, 1 - std::numbers::sqrt2 / 2}) {
    Points points;
    for (int k = 0; k < 4; ++k) {
      const double c = std::cos(k * std::numbers::pi / 2), s = std::sin(k * std::numbers::pi / 2);
      for (const double y : {-1 + 2 * cut, 1 - 2 * cut})
        points.emplace_back(c - s * y, s + c * y, 0);
    }
    const std::vector<std::uint8_t> lines = tangent_lines(points, true);
    EXPECT_EQ(std::count(lines.begin(), lines.end(), 1), 0) << cut;
  }
}

}  // namespace
}  // namespace fairing::test
