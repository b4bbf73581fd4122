// SPDX-License-Identifier: GPL-3.0-or-later
// Fits and charts.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "level_settings.h"
#include "random.h"
#include "stencil/fit.h"

namespace fairing::test {
namespace {

Chart random_ring(int valence, std::mt19937& random, double skew = 1) {
  UniformReal<> vary(-0.3, 0.3);
  Chart chart;
  for (int j = 0; j < valence; ++j) {
    const double angle = 2 * pi * (j + vary(random)) / valence, radius = 1 + vary(random);
    chart.ring.push_back(Vec2(skew * radius * std::cos(angle), radius * std::sin(angle)));
  }
  return chart;
}

// The second derivatives of a quadratic by any weights, as an error.
double hessian_error(const Chart& chart, const Coefficients& c, std::mt19937& random) {
  UniformReal<> weight(0.5, 2);
  std::vector<double> weights;
  for (std::size_t j = 0; j < chart.ring.size(); ++j) weights.push_back(weight(random));
  std::vector<Vec3> rows;
  hessian_rows(chart.ring, weights, rows);
  Vec3 found = Vec3::Zero();
  for (std::size_t j = 0; j < rows.size(); ++j) found += basis(chart.ring[j]).dot(c) * rows[j];
  return (found - c.tail<3>()).norm();
}

// The fit of a quadratic with these coefficients, as an error relative to them.
double fit_error(const Chart& chart, const Coefficients& c) {
  const FitRows rows = fit(chart);
  Coefficients found = Coefficients::Zero();
  for (std::size_t j = 0; j < chart.ring.size(); ++j)
    found += rows.col(Eigen::Index(j)) * basis(chart.ring[j]).dot(c);
  return (found - c).norm() / c.norm();
}

TEST(Fit, IsExactOnQuadratics) {
  std::mt19937 random(3);
  for (int valence = 5; valence <= 40; ++valence)
    for (int trial = 0; trial < 20; ++trial) {
      const Chart chart = random_ring(valence, random);
      const Coefficients c = Coefficients::Random();
      EXPECT_LT(fit_error(chart, c), 1e-9) << valence;
      EXPECT_LT(hessian_error(chart, c, random), 1e-8) << valence;
    }
}

TEST(Fit, FewNeighboursMeasureTheLaplacian) {
  std::mt19937 random(5);
  Coefficients round;
  round << 0.3, -0.8, 1, 0, 0;
  for (const int valence : {3, 4})
    for (int trial = 0; trial < 50; ++trial)
      EXPECT_LT(fit_error(random_ring(valence, random), round), 1e-11);
  // Valence 3 knows no trace-free part; at valence 4 it has one row, and agrees with the data.
  EXPECT_LT(fit(random_ring(3, random)).bottomRows(2).norm(), 1e-11);
  for (int trial = 0; trial < 50; ++trial) {
    const Chart chart = random_ring(4, random);
    const FitRows rows = fit(chart);
    const Eigen::JacobiSVD<Dense> svd(rows.bottomRows(2));
    EXPECT_LT(svd.singularValues()(1), 1e-10 * svd.singularValues()(0));
    Eigen::Matrix<double, 4, 5> a;
    for (int j = 0; j < 4; ++j) a.row(j) = basis(chart.ring[std::size_t(j)]).transpose();
    EXPECT_LT((a * rows - Dense::Identity(4, 4)).norm(), 1e-9);  // it interpolates
  }
}

TEST(Fit, OpenRingsFitTheirGradient) {
  std::mt19937 random(6);
  Coefficients linear;
  linear << 0.3, -0.8, 0, 0, 0;
  for (int valence = 2; valence <= 9; ++valence) {
    Chart chart = random_ring(2 * valence, random);
    chart.ring.resize(std::size_t(valence));
    chart.closed = false;
    EXPECT_LT(fit_error(chart, linear), 1e-9) << valence;
    EXPECT_TRUE(fit(chart).allFinite());
  }
}

// Neighbours on two lines through the origin, a conic, but for so much of an angle.
std::vector<Vec2> ring_near_conic(int valence, double off, std::mt19937& random) {
  UniformReal<> vary(-1, 1);
  const double between = 0.5 * pi * (1 + 0.3 * vary(random));
  std::vector<double> angles{0, between, pi, pi + between};
  while (int(angles.size()) < valence) angles.push_back(angles[angles.size() - 4]);
  for (double& angle : angles) angle += off * vary(random);
  std::sort(angles.begin(), angles.end());
  std::vector<Vec2> ring;
  for (const double angle : angles)
    ring.push_back((1 + 0.3 * vary(random)) * Vec2(std::cos(angle), std::sin(angle)));
  return ring;
}

// A Hessian in the orthonormal basis, after its chart has been turned back.
Vec3 turned_back(const Vec3& hessian, double angle) {
  Vec3 out = hessian;
  out.tail<2>() = Eigen::Rotation2Dd(-2 * angle) * hessian.tail<2>();
  return out;
}

TEST(Fit, DoesNotDependOnTheFirstNeighbour) {
  std::mt19937 random(7);
  UniformReal<> vary(-1, 1);
  for (int trial = 0; trial < 600; ++trial) {
    const int valence = 4 + trial % 5;
    // About the size at which a direction counts as undetermined.
    const std::vector<Vec2> ring =
        ring_near_conic(valence, std::pow(10, -2 + vary(random)), random);
    std::vector<double> difference, weight;
    for (const Vec2& p : ring) {
      difference.push_back(vary(random));
      weight.push_back(1 / p.squaredNorm());
    }
    Vec3 expected[2];
    for (std::size_t first = 0; first < ring.size(); ++first) {
      const Vec2& axis = ring[first];
      const double angle = -std::atan2(axis.y(), axis.x());
      Chart chart;
      std::vector<double> f = difference, w = weight;
      std::rotate(f.begin(), f.begin() + std::ptrdiff_t(first), f.end());
      std::rotate(w.begin(), w.begin() + std::ptrdiff_t(first), w.end());
      for (std::size_t j = 0; j < ring.size(); ++j)
        chart.ring.push_back(Eigen::Rotation2Dd(angle) * ring[(first + j) % ring.size()]);
      const FitRows rows = fit(chart);
      std::vector<Vec3> of_neighbour;
      hessian_rows(chart.ring, w, of_neighbour);
      Vec3 found[2] = {Vec3::Zero(), Vec3::Zero()};
      for (std::size_t j = 0; j < ring.size(); ++j) {
        found[0] += f[j] * rows.col(Eigen::Index(j)).tail<3>();
        found[1] += f[j] * of_neighbour[j];
      }
      for (int k = 0; k < 2; ++k) {
        const Vec3 seen = turned_back(found[k], angle);
        if (first == 0) expected[k] = seen;
        EXPECT_LT((seen - expected[k]).norm(), 1e-8 * (1 + expected[k].norm()))
            << valence << " " << trial << " " << k;
      }
    }
  }
}

double turning(const Chart& chart) {
  double sum = 0;
  for (std::size_t j = 0; j < chart.ring.size(); ++j) {
    const Vec2 &a = chart.ring[j], &b = chart.ring[(j + 1) % chart.ring.size()];
    sum += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return sum;
}

TEST(Charts, GoRoundOnce) {
  for (const double exponent : {0.0, 0.5, 1.0})
    for (const auto& [name, mesh] : all_meshes()) {
      SCOPED_TRACE(name);
      const ChartMaker charts(mesh, exponent);
      for (Index v = 0; v < mesh.vertex_count(); ++v)
        EXPECT_NEAR(mesh.interior(v) ? turning(charts.vertex(v)) : 2 * pi, 2 * pi, 1e-12);
      for (Index e = 0; e < Index(mesh.edges.size()); ++e)
        EXPECT_NEAR(mesh.edges[std::size_t(e)].boundary() ? 2 * pi : turning(charts.edge(e)),
                    2 * pi, 1e-12);
      for (Index f = 0; f < Index(mesh.faces.size()); ++f)
        EXPECT_NEAR(turning(charts.face(f)), 2 * pi, 1e-12);
    }
}

TEST(Charts, SharesAddUpToTheArea) {
  // A control vertex, the points of an edge and those of a face share the metric's area between
  // them.
  for (const auto& [name, mesh] : all_meshes()) {
    SCOPED_TRACE(name);
    const ChartMaker charts(mesh, 1);
    const std::vector<FlatFace> flat = flatten(mesh, 1);
    for (const int n : {1, 2, 4, 8}) {
      double area = 0, expected = 0;
      for (Index v = 0; v < mesh.vertex_count(); ++v)
        if (!mesh.ring(v).empty()) area += charts.vertex(v).area;
      for (Index e = 0; e < Index(mesh.edges.size()); ++e) area += (n - 1) * charts.edge(e).area;
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        area += double(interior_size(mesh.faces[f].quad(), n)) * charts.face(Index(f)).area;
        expected += flat[f].area;
      }
      EXPECT_NEAR(area / n / n, expected, 1e-12 * expected) << n;
    }
  }
}

TEST(Charts, TangentPlaneSeesAFlatMeshAsItIs) {
  const ControlMesh mesh = control(mixed_grid(4, 4));
  const TangentCharts tangent(mesh);
  const ChartMaker plane(mesh, 1);
  const auto expect_congruent = [](const Chart& a, const Chart& b) {
    ASSERT_EQ(a.ring.size(), b.ring.size());
    for (std::size_t j = 0; j < a.ring.size(); ++j) {
      EXPECT_NEAR(a.ring[j].norm(), b.ring[j].norm(), 1e-13);
      EXPECT_NEAR((a.ring[j] - a.ring[0]).norm(), (b.ring[j] - b.ring[0]).norm(), 1e-13);
    }
    EXPECT_NEAR(a.area, b.area, 1e-13);
  };
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    expect_congruent(tangent.vertex(v), plane.vertex(v));
  for (Index e = 0; e < Index(mesh.edges.size()); ++e)
    expect_congruent(tangent.edge(e), plane.edge(e));
}

}  // namespace
}  // namespace fairing::test
