// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/curve.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "random.h"

namespace fairing::test {
namespace {

using Points = std::vector<Vec3>;

Points random_chain(unsigned seed, int count) {
  std::mt19937 random(seed);
  Normal<> coordinate;
  Points points;
  for (int i = 0; i < count; ++i) {
    const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
    points.emplace_back(x, y, z);
  }
  return points;
}

double distance(const Points& a, const Points& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

// Makes the sum of ω |second divided difference|² stationary in all points but the given ones; in
// parabolic end segments the second differences are equal instead. A dense system.
Points solve_directly(const Points& vertices, bool closed, const CurveScheme& scheme) {
  const int n = scheme.subdivisions;
  const int count = int(vertices.size()), segments = closed ? count : count - 1,
            points = segments * n + !closed;
  std::vector<double> spacing;
  for (int s = 0; s < segments; ++s)
    for (int i = 0; i < n; ++i)
      spacing.push_back(
          std::pow((vertices[std::size_t((s + 1) % count)] - vertices[std::size_t(s)]).norm(),
                   scheme.exponent) /
          n);

  const int first = closed ? 0 : 1, rows = closed ? points : points - 2;
  Eigen::MatrixXd differences = Eigen::MatrixXd::Zero(rows, points);
  Eigen::VectorXd weights(rows);
  for (int r = 0; r < rows; ++r) {
    const int i = first + r, before = (i + points - 1) % points, after = (i + 1) % points;
    const double left = spacing[std::size_t(closed ? before : i - 1)],
                 right = spacing[std::size_t(i)];
    const double weight =
        (left + right) / 2;  // ω, and the denominator of the second divided difference
    differences(r, before) += 1 / left;
    differences(r, i) -= 1 / left + 1 / right;
    differences(r, after) += 1 / right;
    differences.row(r) /= weight;
    weights[r] = weight;
  }
  Eigen::MatrixXd system = differences.transpose() * weights.asDiagonal() * differences;
  Eigen::MatrixXd value = Eigen::MatrixXd::Zero(points, 3);
  const auto end_segment = [&](int i) {
    return scheme.ends == ChainEnds::parabolic && !closed && count > 2 &&
           (i < n || i > points - 1 - n);
  };
  for (int i = 0; i < points; ++i) {
    if (i % n == 0) {
      system.row(i) = Eigen::RowVectorXd::Unit(points, i);
      value.row(i) = vertices[std::size_t(i / n)].transpose();
    } else if (end_segment(i)) {  // row i - 1 is the difference at point i
      system.row(i) = differences.row(i - 1) - differences.row(i < n ? i : i - 2);
    }
  }
  const Eigen::MatrixXd solution = system.fullPivLu().solve(value);
  Points result;
  for (int i = 0; i < points; ++i)
    if (i % n != 0) result.push_back(solution.row(i).transpose());
  return result;
}

Points refined(const Points& chain, bool closed, const CurveScheme& scheme) {
  return refine_chain(chain, chain, closed, scheme);
}

TEST(Curve, MinimizesTheSquaredSecondDividedDifferences) {
  for (const double exponent : {0.0, 0.5, 1.0})
    for (const int count : {2, 3, 4, 7})
      for (const int n : {2, 3, 8})
        for (const bool closed : {false, true})
          for (const ChainEnds ends : {ChainEnds::natural, ChainEnds::parabolic}) {
            if (closed && count < 3) continue;
            const Points chain = random_chain(unsigned(count), count);
            EXPECT_LT(distance(refined(chain, closed, {n, exponent, ends}),
                               solve_directly(chain, closed, {n, exponent, ends})),
                      1e-9)
                << count << " vertices, N = " << n << ", exponent " << exponent
                << (closed ? ", closed" : "") << ", ends " << int(ends);
          }
}

Points reversed_result(Points points) {
  std::reverse(points.begin(), points.end());
  return points;
}

TEST(Curve, LoopsAreBitIdenticalFromAnyVertex) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const int count = 3 + int(seed % 7), n = 4;
    Points loop = random_chain(seed, count);
    if (seed % 2)
      loop[std::size_t(count) - 1] = loop[0] =
          Vec3(-9, 0, 0);  // the least point twice, not side by side
    if (seed % 2) std::rotate(loop.begin(), loop.begin() + 1, loop.end());
    if (seed % 2 && count > 3) std::swap(loop[0], loop[std::size_t(count) - 1]);
    if (seed % 2) loop[1] = Vec3(1, double(seed), 2);
    const Points points = refined(loop, true, {n, 0.5});
    for (int shift = 0; shift < count; ++shift) {
      Points turned = loop, expected = points;
      std::rotate(turned.begin(), turned.begin() + shift, turned.end());
      std::rotate(expected.begin(), expected.begin() + shift * (n - 1), expected.end());
      EXPECT_EQ(refined(turned, true, {n, 0.5}), expected);
      // Backwards from the same vertex, the last segment comes first.
      std::reverse(turned.begin() + 1, turned.end());
      EXPECT_EQ(refined(turned, true, {n, 0.5}), reversed_result(expected));
    }
  }
}

// The boundary of a slit: if its two strands did not agree, the slit would gape.
TEST(Curve, StrandsAtTheSamePlaceAgree) {
  Points slit = random_chain(4, 6);
  for (std::size_t i = 4; i > 0; --i) slit.push_back(slit[i]);
  const Points points = refined(slit, true, {4, 0.5});
  EXPECT_EQ(points, reversed_result(points));
}

}  // namespace
}  // namespace fairing::test
