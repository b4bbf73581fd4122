// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of strongly coupled points: what operators write along them against their matrices, and the
// smoother's solves against dense ones.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "curvature/level.h"
#include "level_settings.h"
#include "multigrid/line_jacobi.h"
#include "polyhedron.h"
#include "thin_plate/differences.h"
#include "thin_plate/level.h"
#include "thin_plate/operator.h"

namespace fairing::test {
namespace {

// Along x stretched: faces as thin as that.
OwnedPolygonMesh stretched(OwnedPolygonMesh mesh, double by) {
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += 3) mesh.coordinates[i] *= by;
  return mesh;
}

// K over all points, zero on those that are no unknowns.
Dense over_points(const AssembledSystem& system, std::size_t points) {
  Dense k = Dense::Zero(Eigen::Index(points), Eigen::Index(points));
  const Dense own(system.matrix);
  for (std::size_t i = 0; i < system.unknown_points.size(); ++i)
    for (std::size_t j = 0; j < system.unknown_points.size(); ++j)
      k(system.unknown_points[i], system.unknown_points[j]) = own(Eigen::Index(i), Eigen::Index(j));
  return k;
}

// Every line's numbers are those of K, and what is off the band is no less than in K.
void expect_numbers_of(const Dense& k, const LineBand& band) {
  std::set<Index> seen;
  const double size = k.norm();
  for (std::size_t l = 0; l < band.lines(); ++l) {
    const Index* point = band.points_of(l);
    EXPECT_GE(band.length(l), 2u);
    for (std::size_t i = 0; i < band.length(l); ++i) {
      EXPECT_TRUE(seen.insert(point[i]).second);
      const float* number = band.numbers().data() + 3 * std::size_t(point[i]);
      double off = 0;
      for (std::size_t j = 0; j < band.length(l); ++j)
        if (j + 2 < i || j > i + 2) off += std::abs(k(point[i], point[j]));
      EXPECT_GE(number[0], off - 1e-6 * size);
      for (std::size_t before = 1; before <= 2 && before <= i; ++before)
        EXPECT_NEAR(number[before], k(point[i], point[i - before]), 1e-6 * size);
    }
  }
}

Array<float> inverse_of(const Dense& k) {
  Array<float> out(std::size_t(k.rows()));
  for (Eigen::Index i = 0; i < k.rows(); ++i)
    out[std::size_t(i)] = k(i, i) > 0 ? float(1 / k(i, i)) : 1.0f;
  return out;
}

TEST(Lines, OfAPlateAreItsMatrix) {
  std::size_t points = 0;
  for (const auto& [name, mesh] : all_meshes())
    for (int l = 1; l <= 3; ++l) {
      SCOPED_TRACE(name + ", level " + std::to_string(l));
      Workers workers(2);
      const GridLevel grid(mesh, l);
      const auto charts = charts_of()(mesh);
      const Stencils stencils = make_stencils(mesh, *charts, workers);
      const Unknowns unknowns = some_points(mesh, 1);
      const Dense k =
          over_points(assemble_thin_plate(grid, stencils, unknowns, {}, workers), grid.size());
      const Array<float> inverse = inverse_of(k);
      const PlateDifferences rows(grid, stencils, unknowns, workers);
      LineBand band(grid.size());
      band.write(inverse, [&](const auto& wants, const auto& visit) {
        visit_numbers(rows, workers, wants, visit);
      });
      EXPECT_FALSE(band.is_seeking());
      expect_numbers_of(k, band);
      for (std::size_t line = 0; line < band.lines(); ++line) points += band.length(line);
      const RingMatrix<3> matrix(rows, workers);
      LineBand of_matrix(grid.size());
      of_matrix.write(inverse, [&](const auto& wants, const auto& visit) {
        matrix.visit_numbers(workers, wants, visit);
      });
      expect_numbers_of(k, of_matrix);
    }
  EXPECT_GT(points, 100u);
}

TEST(Lines, OfTotalCurvatureAreItsMatrixWithoutDamping) {
  for (const double by : {1.0, 4.0})
    for (int l = 2; l <= 4; ++l) {
      SCOPED_TRACE(std::to_string(by) + ", level " + std::to_string(l));
      const ControlMesh mesh = control(stretched(octahedron(), by));
      const GridLevel grid(mesh, l);
      Workers workers(2);
      CurvatureShared shared{mesh, some_points(mesh, 0), workers};
      CurvatureLevel level(shared, grid);
      Array<double> x(3 * grid.size());
      refine_linearly(grid, mesh.positions, x.data());
      for (std::size_t i = 0; i < x.size(); i += 3) {
        const double radius = std::hypot(x[i] / by, x[i + 1], x[i + 2]);
        for (std::size_t a = 0; a < 3; ++a) x[i + a] /= radius;
      }
      level.linearize(x.data(), {});
      LineBand band(grid.size());
      level.write_lines(band, workers);
      expect_numbers_of(over_points(level.assemble(), grid.size()), band);
      EXPECT_TRUE(by == 1 || band.lines() > 0);
    }
}

// An operator of one's own: a dense matrix.
class DenseOperator final : public LevelOperator {
 public:
  DenseOperator(Dense k, std::size_t components)
      : k_(std::move(k)), components_(components), inverse_(inverse_of(k_)) {}
  std::size_t points() const override { return std::size_t(k_.rows()); }
  std::size_t components() const override { return components_; }
  void apply(const double*, double*) override {}
  void apply(const float*, float*) override {}
  const Array<float>& inverse_diagonal() const override { return inverse_; }
  AssembledSystem assemble() const override { return {}; }
  void write_lines(LineBand& band, Workers&) override {
    band.write(inverse_, [&](const auto& wants, const auto& visit) {
      for (Eigen::Index p = 0; p < k_.rows(); ++p)
        for (Eigen::Index q = 0; q < k_.cols() && wants(Index(p)); ++q)
          if (k_(p, q) != 0) visit(Index(p), Index(q), float(k_(p, q)));
    });
  }

 private:
  Dense k_;
  std::size_t components_;
  Array<float> inverse_;
};

// Beams of several lengths, each with clamped ends, and points that are coupled to none.
Dense beams(const std::vector<int>& lengths, int alone) {
  Eigen::Index size = alone;
  for (const int n : lengths) size += n;
  Dense k = Dense::Zero(size, size);
  Eigen::Index at = 0;
  double scale = 1;
  for (const int n : lengths) {
    for (Eigen::Index i = 0; i < n; ++i) {
      k(at + i, at + i) = 6 * scale;
      if (i + 1 < n) k(at + i, at + i + 1) = k(at + i + 1, at + i) = -4 * scale;
      if (i + 2 < n) k(at + i, at + i + 2) = k(at + i + 2, at + i) = scale;
    }
    at += n;
    scale *= 3;
  }
  for (; at < size; ++at) k(at, at) = 2;
  return k;
}

TEST(Lines, SolveForTheirBand) {
  Workers workers(2);
  for (const std::size_t components : {1u, 3u}) {
    const Dense k = beams({2, 40, 3, 17, 5, 5, 9, 30, 4, 12, 6}, 7);
    DenseOperator op(k, components);
    const LineJacobi lines(op, workers);
    ASSERT_TRUE(lines.any());
    const Eigen::Index size = k.rows(), each = Eigen::Index(components);
    Dense r = Dense::Random(each, size);
    const Dense expected = k.ldlt().solve(r.transpose()).transpose();
    std::vector<float> load(r.data(), r.data() + r.size()), x(load.size()), change(load.size(), 1);
    for (Eigen::Index i = 0; i < size; ++i)
      for (Eigen::Index a = 0; a < each; ++a)
        x[std::size_t(each * i + a)] = float(r(a, i) / k(i, i));
    lines.add(1, load.data(), x.data(), change.data());
    for (Eigen::Index i = 0; i < size; ++i)
      for (Eigen::Index a = 0; a < each; ++a) {
        const auto at = std::size_t(each * i + a);
        EXPECT_NEAR(x[at], expected(a, i), 2e-3 * expected.norm());
        EXPECT_NEAR(change[at] - 1, expected(a, i) - r(a, i) / k(i, i), 2e-3 * expected.norm());
      }
  }
}

// K's numbers between points of a line that are far along it would make its band indefinite.
TEST(Lines, StayDefiniteWhereTheyTurnBack) {
  Workers workers(1);
  Dense k = beams({12}, 0);
  for (Eigen::Index i = 0; i < 4; ++i) k(i, 11 - i) = k(11 - i, i) = 1;
  k += Dense::Identity(12, 12);
  ASSERT_GT(Eigen::SelfAdjointEigenSolver<Dense>(k).eigenvalues()(0), 0);
  DenseOperator op(k, 1);
  const LineJacobi lines(op, workers);
  ASSERT_TRUE(lines.any());
  Dense inverse(12, 12);
  for (Eigen::Index i = 0; i < 12; ++i) {
    std::vector<float> r(12), x(12);
    r[std::size_t(i)] = 1;
    x[std::size_t(i)] = float(1 / k(i, i));
    lines.add(1, r.data(), x.data(), nullptr);
    for (Eigen::Index j = 0; j < 12; ++j) inverse(j, i) = x[std::size_t(j)];
  }
  EXPECT_LT((inverse - inverse.transpose()).norm(), 1e-6 * inverse.norm());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Dense> eigen(
      k, (inverse + inverse.transpose()).inverse() * 2);
  EXPECT_GT(eigen.eigenvalues()(0), 0);
  EXPECT_LT(eigen.eigenvalues()(11), 1 + 1e-4);  // B is no less than K
}

}  // namespace
}  // namespace fairing::test
