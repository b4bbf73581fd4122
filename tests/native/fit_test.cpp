// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of a fit beside what is done the long way.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "fit/feet.h"
#include "fit/point_forces.h"
#include "level_settings.h"
#include "polyhedron.h"
#include "random.h"

namespace fairing::test {
namespace {

constexpr double reach = 0.5;

// A level of a mesh as a surface, and a scan near it.
struct Near {
  Near(const ControlMesh& control, int level, std::size_t count, double off)
      : mesh(control), grid(mesh, level), workers(2), cells(grid, workers), x(3 * grid.size()) {
    refine_linearly(grid, mesh.positions, x.data());
    std::mt19937 random(3);
    Normal<> noise(0, off);
    for (std::size_t s = 0; s < count; ++s) {
      const auto cell = Index(UniformInt(0, int(cells.size()) - 1)(random));
      CornerShares shares{};
      double sum = 0;
      for (std::size_t k = 0; k < (cells.quad(cell) ? 4u : 3u); ++k)
        sum += double(shares[k] = float(0.1 + canonical<double>(random)));
      Vec3 place = Vec3::Zero();
      for (std::size_t k = 0; k < 4; ++k)
        if (shares[k] > 0) place += double(shares[k]) / sum * at(cells.corners(cell)[k]);
      scan.point.push_back(place + Vec3(noise(random), noise(random), noise(random)));
      scan.given.push_back(Index(s));
    }
  }
  Vec3 at(Index p) const { return Eigen::Map<const Vec3>(x.data() + 3 * std::size_t(p)); }

  // The distance of a point from the nearest of a cell's triangles, by many of their points.
  double far(const Vec3& p, Index cell) const {
    const auto& c = cells.corners(cell);
    constexpr int n = 24;
    double least = std::numeric_limits<double>::max();
    const auto look = [&](const Vec3& a, const Vec3& b, const Vec3& d) {
      for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j)
          least = std::min(
              least, (a + double(i) / n * (b - a) + double(j) / n * (d - a) - p).squaredNorm());
    };
    if (!cells.quad(cell)) {
      look(at(c[0]), at(c[1]), at(c[2]));
    } else {
      const Vec3 middle = 0.25 * (at(c[0]) + at(c[1]) + at(c[2]) + at(c[3]));
      for (std::size_t k = 0; k < 4; ++k) look(at(c[k]), at(c[(k + 1) % 4]), middle);
    }
    return std::sqrt(least);
  }

  ControlMesh mesh;
  GridLevel grid;
  Workers workers;
  Cells cells;
  Array<double> x;
  Scan scan;
};

ControlMesh wavy_torus() { return control(waved(torus(8, 6), 0.3)); }
ControlMesh wavy_triangles() { return control(waved(triangulated(torus(8, 6)), 0.3)); }

TEST(Feet, AreNearestPointsOfTheSurface) {
  for (const ControlMesh& mesh : {wavy_torus(), wavy_triangles()}) {
    Near near(mesh, 2, 60, 0.05);
    FeetFinder finder(near.cells, near.scan, reach, near.workers);
    finder.set_surface(near.x.data());
    Array<Foot> feet;
    finder.find(feet);
    for (std::size_t s = 0; s < feet.size(); ++s) {
      ASSERT_GE(feet[s].cell, 0);
      double least = std::numeric_limits<double>::max();
      for (Index c = 0; c < Index(near.cells.size()); ++c)
        least = std::min(least, near.far(near.scan.point[s], c));
      const double found = (near.scan.point[s] - finder.point_at_foot(feet[s])).norm();
      EXPECT_LE(found, least + 1e-6);
      EXPECT_NEAR(std::abs(finder.distance(s, feet[s])), found, 1e-12);
    }
  }
}

TEST(Pulls, AreSumsOverThePointsForAnyNumberOfThreads) {
  Near near(wavy_triangles(), 2, 2000, 0.05);
  FeetFinder finder(near.cells, near.scan, reach, near.workers);
  finder.set_surface(near.x.data());
  Array<Foot> feet;
  finder.find(feet);
  Array<float> robust_weight;
  for (std::size_t s = 0; s < feet.size(); ++s) robust_weight.push_back(float(s % 3) / 2);
  VertexWeights weight, other;
  Array<Vec3> force, elsewhere;
  PointForces(near.cells, near.workers).sum(finder, feet, robust_weight, weight, force);
  Workers alone(1);
  PointForces(near.cells, alone).sum(finder, feet, robust_weight, other, elsewhere);
  EXPECT_EQ(weight, other);
  std::vector<double> expected(near.grid.size(), 0.0);
  std::vector<Vec3> pulled(near.grid.size(), Vec3::Zero());
  for (std::size_t s = 0; s < feet.size(); ++s)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto p = std::size_t(near.cells.corners(feet[s].cell)[k]);
      const double share = double(robust_weight[s]) * double(feet[s].shares[k]);
      expected[p] += share;
      pulled[p] += share * double(feet[s].offset) * finder.normal_at(feet[s]);
    }
  for (std::size_t p = 0; p < expected.size(); ++p) {
    EXPECT_NEAR(weight[p], expected[p], 1e-12);
    EXPECT_LT((force[p] - pulled[p]).norm(), 1e-12);
    EXPECT_EQ(force[p], elsewhere[p]);
  }
}

}  // namespace
}  // namespace fairing::test
