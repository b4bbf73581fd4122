// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/curve.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "curves/feature_curves.h"
#include "mesh/validate/check.h"
#include "meshes.h"
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

// Minimizes the sum of ω |second divided difference|² over all points but the given ones, by dense
// least squares.
Points minimize_directly(const Points& vertices, bool closed, int n, double exponent) {
  const int count = int(vertices.size()), segments = closed ? count : count - 1,
            points = segments * n + !closed;
  std::vector<double> spacing;
  for (int s = 0; s < segments; ++s)
    for (int i = 0; i < n; ++i)
      spacing.push_back(
          std::pow((vertices[std::size_t((s + 1) % count)] - vertices[std::size_t(s)]).norm(),
                   exponent) /
          n);

  const int first = closed ? 0 : 1, rows = closed ? points : points - 2;
  Eigen::MatrixXd differences = Eigen::MatrixXd::Zero(rows, points);
  for (int r = 0; r < rows; ++r) {
    const int i = first + r, before = (i + points - 1) % points, after = (i + 1) % points;
    const double left = spacing[std::size_t(closed ? before : i - 1)],
                 right = spacing[std::size_t(i)];
    const double weight =
        (left + right) / 2;  // ω, and the denominator of the second divided difference
    differences(r, before) += 1 / left;
    differences(r, i) -= 1 / left + 1 / right;
    differences(r, after) += 1 / right;
    differences.row(r) *= std::sqrt(weight) / weight;
  }
  Eigen::MatrixXd free(rows, points - count), fixed(rows, count), given(count, 3);
  for (int i = 0, f = 0; i < points; ++i) {
    if (i % n == 0) {
      fixed.col(i / n) = differences.col(i);
      given.row(i / n) = vertices[std::size_t(i / n)].transpose();
    } else {
      free.col(f++) = differences.col(i);
    }
  }
  const Eigen::MatrixXd solution =
      (free.transpose() * free).ldlt().solve(-free.transpose() * (fixed * given));
  Points result;
  for (Eigen::Index i = 0; i < solution.rows(); ++i) result.push_back(solution.row(i).transpose());
  return result;
}

TEST(Curve, MinimizesTheSquaredSecondDividedDifferences) {
  for (const double exponent : {0.0, 0.5, 1.0})
    for (const int count : {2, 3, 4, 7})
      for (const int n : {2, 3, 8})
        for (const bool closed : {false, true}) {
          if (closed && count < 3) continue;
          const Points chain = random_chain(unsigned(count), count);
          EXPECT_LT(distance(refine_chain(chain, closed, n, exponent),
                             minimize_directly(chain, closed, n, exponent)),
                    1e-9)
              << count << " vertices, N = " << n << ", exponent " << exponent
              << (closed ? ", closed" : "");
        }
}

TEST(Curve, ReproducesStraightLines) {
  const Points chain{{0, 0, 0}, {1, 2, 3}, {3, 6, 9}, {3.5, 7, 10.5}};
  const Points points = refine_chain(chain, false, 4, 1.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t s = i / 3;
    EXPECT_LT((points[i] - (chain[s] + (double(i % 3 + 1) / 4) * (chain[s + 1] - chain[s]))).norm(),
              1e-14);
  }
}

// Fourth order, as a periodic cubic spline.
TEST(Curve, ApproximatesTheCircle) {
  double last = 1;
  for (const int count : {8, 16, 32}) {
    Points circle;
    for (int i = 0; i < count; ++i)
      circle.emplace_back(std::cos(2 * std::numbers::pi * i / count),
                          std::sin(2 * std::numbers::pi * i / count), 0);
    double error = 0;
    for (const Vec3& p : refine_chain(circle, true, 64, 0.5))
      error = std::max(error, std::abs(p.norm() - 1));
    EXPECT_LT(error, last / 14);
    last = error;
  }
}

Points reversed_result(Points points) {
  std::reverse(points.begin(), points.end());
  return points;
}

TEST(Curve, BitIdenticalInBothDirections) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Points chain = random_chain(seed, 2 + int(seed % 9));
    EXPECT_EQ(refine_chain(reversed_result(chain), false, 5, 0.5),
              reversed_result(refine_chain(chain, false, 5, 0.5)));
  }
  Points bow = random_chain(3, 6);  // ends where it starts: the next vertices decide
  bow.back() = bow.front();
  EXPECT_EQ(refine_chain(reversed_result(bow), false, 5, 0.5),
            reversed_result(refine_chain(bow, false, 5, 0.5)));
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
    const Points points = refine_chain(loop, true, n, 0.5);
    for (int shift = 0; shift < count; ++shift) {
      Points turned = loop, expected = points;
      std::rotate(turned.begin(), turned.begin() + shift, turned.end());
      std::rotate(expected.begin(), expected.begin() + shift * (n - 1), expected.end());
      EXPECT_EQ(refine_chain(turned, true, n, 0.5), expected);
      // Backwards from the same vertex, the last segment comes first.
      std::reverse(turned.begin() + 1, turned.end());
      EXPECT_EQ(refine_chain(turned, true, n, 0.5), reversed_result(expected));
    }
  }
}

// The boundary of a slit: if its two strands did not agree, the slit would gape.
TEST(Curve, StrandsAtTheSamePlaceAgree) {
  Points slit = random_chain(4, 6);
  for (std::size_t i = 4; i > 0; --i) slit.push_back(slit[i]);
  const Points points = refine_chain(slit, true, 4, 0.5);
  EXPECT_EQ(points, reversed_result(points));
}

ControlMesh build(const OwnedPolygonMesh& mesh, const FeatureOptions& features) {
  check(mesh.view());
  return make_control_mesh(mesh.view(), features);
}

TEST(FeatureCurves, RunsFollowTheirEdges) {
  OwnedPolygonMesh cylinder = open_cylinder(6);
  for (std::size_t i = 2; i < cylinder.coordinates.size(); i += 3)
    cylinder.coordinates[i] += 0.3 * std::sin(double(i));
  const ControlMesh mesh = build(cylinder, {.crease_edges = {{0, 1}}});
  const FeatureCurves curves = refine_feature_edges(mesh, 8, 0.5);
  std::size_t runs = 0;
  for (Index e = 0; e < Index(mesh.edges.size()); ++e) {
    EXPECT_EQ(curves.run[std::size_t(e)] >= 0, mesh.feature_edge[std::size_t(e)] != 0);
    if (curves.run[std::size_t(e)] < 0) continue;
    ++runs;
    const auto run = curves.of(e);
    const Vec3& a = mesh.positions[std::size_t(mesh.edges[std::size_t(e)].vertex[0])];
    const Vec3& b = mesh.positions[std::size_t(mesh.edges[std::size_t(e)].vertex[1])];
    ASSERT_EQ(run.size(), 7u);
    EXPECT_LT((run.front() - a).norm(), (run.back() - a).norm());
    EXPECT_LT((run.back() - b).norm(), (run.front() - b).norm());
  }
  EXPECT_EQ(curves.points.size(), 7 * runs);
}

}  // namespace
}  // namespace fairing::test
