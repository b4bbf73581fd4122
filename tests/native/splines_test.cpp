// SPDX-License-Identifier: GPL-3.0-or-later
// Spline patches against surfaces that are known: a bicubic comes back, a sphere is met within the
// tolerance, curves are refined and halved exactly.
#include "splines/fit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fairing::test {
namespace {

// Control quads over grids of points, refined by what `at` says: no solver takes part.
struct Refined {
  int levels;
  std::vector<double> vertices;
  std::vector<std::int32_t> triangles, quads;

  RefinedSurface view() const { return {levels, vertices, triangles, quads, {}}; }
};

// columns x 1 quads over [0, columns] x [0, 1].
template <class At>
Refined strip(int columns, int levels, At&& at) {
  Refined out{levels, {}, {}, {}};
  const int n = 1 << levels, width = columns * n + 1;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i < width; ++i)
      for (const double x : at(double(i) / n, double(j) / n)) out.vertices.push_back(x);
  for (int f = 0; f < columns; ++f)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int first = j * width + f * n + i;
        for (const int p : {first, first + 1, first + width + 1, first + width})
          out.quads.push_back(p);
      }
  return out;
}

// One triangle with corners (0, 0), (1, 0), (0, 1).
template <class At>
Refined triangle(int levels, At&& at) {
  Refined out{levels, {}, {}, {}};
  const int n = 1 << levels;
  std::vector<int> row;
  for (int j = 0; j <= n; ++j) {
    row.push_back(int(out.vertices.size() / 3));
    for (int i = 0; i + j <= n; ++i)
      for (const double x : at(double(i) / n, double(j) / n)) out.vertices.push_back(x);
  }
  const auto point = [&](int i, int j) { return row[std::size_t(j)] + i; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i + j < n; ++i) {
      for (const int p : {point(i, j), point(i + 1, j), point(i, j + 1)})
        out.triangles.push_back(p);
      if (i + j + 1 < n)
        for (const int p : {point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)})
          out.triangles.push_back(p);
    }
  return out;
}

Vec3 on_sphere(double u, double v) {
  const double a = 0.6 * (u - 1), b = 0.6 * (v - 0.5);
  return Vec3(std::tan(a), std::tan(b), 1).normalized();
}

SplineSurface fitted(const Refined& surface, const SplineOptions& options = {}) {
  Monitor monitor;
  return fit_splines(surface.view(), options, monitor);
}

double sphere_error(const SplineSurface& surface) {
  double error = 0;
  for (const SplinePatch& patch : surface.patches)
    for (int j = 0; j <= 20; ++j)
      for (int i = 0; i <= 20; ++i)
        error = std::max(error, std::abs(patch.at(i / 20.0, j / 20.0).at.norm() - 1));
  return error;
}

double largest(const std::vector<double>& values) {
  double out = 0;
  for (const double x : values)
    if (x > out) out = x;
  return out;
}

TEST(Splines, BasisSumsToOneAndItsSlopesAreDerivatives) {
  for (const int spans : {1, 2, 4, 8})
    for (int k = 1; k < 100; ++k) {
      const double t = k / 100.0, h = 1e-6;
      const CubicBasis b = cubic_basis(spans, t);
      const CubicBasis next = cubic_basis(spans, t + h), before = cubic_basis(spans, t - h);
      double sum = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        sum += b.value[i];
        if (next.first == before.first) {
          EXPECT_NEAR(b.slope[i], (next.value[i] - before.value[i]) / (2 * h), 1e-6 * spans);
        }
      }
      EXPECT_NEAR(sum, 1, 1e-14);
    }
}

TEST(Splines, CurvesAreRefinedAndHalvedExactly) {
  SplineCurve curve{2, {}};
  for (int i = 0; i < control_points(2); ++i)
    curve.points.emplace_back(i, std::sin(2.0 * i), std::cos(3.0 * i));
  const SplineCurve fine = refined(curve, 8), first = half_of(curve, false),
                    second = half_of(fine, true);
  EXPECT_EQ(fine.spans, 8);
  EXPECT_EQ(first.spans, 1);
  EXPECT_EQ(second.spans, 4);
  for (int k = 0; k <= 40; ++k) {
    const double t = k / 40.0;
    EXPECT_LT((fine.at(t).at - curve.at(t).at).norm(), 1e-14);
    EXPECT_LT((first.at(t).at - curve.at(t / 2).at).norm(), 1e-14);
    EXPECT_LT((second.at(t).at - curve.at((1 + t) / 2).at).norm(), 1e-14);
    EXPECT_LT((reversed(curve).at(1 - t).at - curve.at(t).at).norm(), 1e-14);
  }
}

TEST(Splines, APlaneIsOneSpan) {
  const SplineSurface surface =
      fitted(strip(2, 3, [](double u, double v) { return Vec3(u, v, u - 2 * v); }));
  ASSERT_EQ(surface.patches.size(), 2u);
  for (const SplinePatch& patch : surface.patches) {
    EXPECT_EQ(patch.spans_u * patch.spans_v, 1);
    for (int k = 0; k <= 10; ++k) {
      const Vec3 at = patch.at(k / 10.0, 0.3).at;
      EXPECT_NEAR(at.z(), at.x() - 2 * at.y(), 1e-12);
    }
  }
  EXPECT_EQ(surface.edges.size(), 7u);
  EXPECT_EQ(surface.vertices.size(), 6u);
  EXPECT_LT(largest(surface.angles), 1e-7);
}

TEST(Splines, QuadsOnASphereAreWithinTheTolerance) {
  for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
    const SplineSurface surface = fitted(strip(2, 6, on_sphere), {.tolerance = tolerance});
    EXPECT_LE(largest(surface.residual), tolerance * surface.size);
    EXPECT_LE(sphere_error(surface), tolerance);
    EXPECT_LE(largest(surface.angles), 8e-4);
    EXPECT_EQ(surface.edges.size(), 7u);
  }
}

TEST(Splines, ATriangleIsThreePatchesAroundItsCentroid) {
  const SplineSurface surface = fitted(triangle(5, on_sphere));
  ASSERT_EQ(surface.patches.size(), 3u);
  EXPECT_EQ(surface.edges.size(), 9u);     // six halves, three inside
  EXPECT_EQ(surface.vertices.size(), 7u);  // corners, middles, centroid
  EXPECT_LE(sphere_error(surface), 1e-4);
  EXPECT_LE(largest(surface.angles), 8e-4);
  for (const std::vector<LoopEdge>& loop : surface.loops) EXPECT_EQ(loop.size(), 4u);
}

TEST(Splines, ASharpLatticeSaysSo) {
  const Refined smooth = strip(1, 4, [](double u, double v) { return Vec3(u, v, 0); });
  Refined sharp = smooth;
  sharp.vertices[3 * (8 * 17 + 8) + 2] = 0.2;
  EXPECT_LT(largest(fitted(smooth).lattice_turn), 1e-7);
  EXPECT_GT(largest(fitted(sharp).lattice_turn), 0.35);
}

TEST(Splines, RefusesWhatIsNoRefinedSurface) {
  Refined surface = strip(1, 3, on_sphere);
  surface.quads.pop_back();
  EXPECT_THROW(fitted(surface), FairingError);
  surface = strip(1, 3, on_sphere);
  surface.quads[5] = 1000;
  EXPECT_THROW(fitted(surface), FairingError);
}

TEST(Splines, CanBeCancelled) {
  const Refined surface = strip(2, 5, on_sphere);
  for (const int question : {1, 5, 40}) {
    Monitor monitor;
    monitor.cancel_at_question(question);
    EXPECT_THROW(fit_splines(surface.view(), {}, monitor), FairingError);
  }
}

}  // namespace
}  // namespace fairing::test
