// SPDX-License-Identifier: GPL-3.0-or-later
// Spline patches against surfaces that are known: a bicubic comes back, a sphere is met within the
// tolerance, curves are refined and cut exactly.
#include "splines/fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "refined_surfaces.h"
#include "splines/face_surface.h"

namespace fairing::test {
namespace {

Vec3 on_sphere(double u, double v) {
  const double a = 0.6 * (u - 1), b = 0.6 * (v - 0.5);
  return Vec3(std::tan(a), std::tan(b), 1).normalized();
}

SplineSurface fitted(const Refined& surface, const SplineOptions& options = {1e-4, 8e-4}) {
  Monitor monitor;
  return fit_splines(surface.view(), options, monitor);
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

TEST(Splines, CurvesAreRefinedAndCutExactly) {
  SplineCurve curve{2, {}};
  for (int i = 0; i < control_points(2); ++i)
    curve.points.emplace_back(i, std::sin(2.0 * i), std::cos(3.0 * i));
  const SplineCurve fine = refined(curve, 8), thirds = refined(curve, 6),
                    first = part_of(curve, 0, 1, 2), second = part_of(fine, 1, 2, 2),
                    third = part_of(thirds, 1, 2, 3);
  EXPECT_EQ(fine.spans, 8);
  EXPECT_EQ(first.spans, 1);
  EXPECT_EQ(second.spans, 4);
  for (int k = 0; k <= 40; ++k) {
    const double t = k / 40.0;
    EXPECT_LT((fine.at(t).at - curve.at(t).at).norm(), 1e-14);
    EXPECT_LT((first.at(t).at - curve.at(t / 2).at).norm(), 1e-14);
    EXPECT_LT((second.at(t).at - curve.at((1 + t) / 2).at).norm(), 1e-14);
    EXPECT_LT((third.at(t).at - curve.at((1 + t) / 3).at).norm(), 1e-14);
    EXPECT_LT((reversed(curve).at(1 - t).at - curve.at(t).at).norm(), 1e-14);
  }
}

// Of points over the middle of each cell: what lies on the sphere is not off, what is lifted from it
// is by as much.
TEST(Splines, HeightsAreKnownBetweenTheLatticesPoints) {
  for (const bool quads : {true, false}) {
    const Refined surface = quads ? strip(1, 4, on_sphere) : triangle(4, on_sphere);
    const Lattice lattice(surface.view());
    Topology topology = make_topology(lattice);
    topology.kinks.assign(topology.sectors.size(), Kink::none);
    const FaceSurface face(Sheet(lattice, 0), topology);
    const double none[] = {0}, much[] = {0.02};
    const int n = lattice.n();
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < (quads ? n : n - j); ++i) {
        const double u = (i + 0.4) / n, v = (j + 0.4) / n;
        const Vec3 on = on_sphere(u, v);
        EXPECT_EQ(face.height(on, -1, u, v, none).by, 0);
        for (const double lifted : {0.01, -0.01})
          EXPECT_NEAR(face.height((1 + lifted) * on, -1, u, v, none).by, 0.01, 1e-3);
        EXPECT_EQ(face.height(1.01 * on, -1, u, v, much).by, 0);
      }
  }
}

TEST(Splines, RefusesWhatIsNoRefinedSurface) {
  Refined surface = strip(1, 3, on_sphere);
  surface.quads.pop_back();
  EXPECT_THROW(fitted(surface), FairingError);
  surface = strip(1, 3, on_sphere);
  surface.quads[5] = 1000;
  EXPECT_THROW(fitted(surface), FairingError);
}

}  // namespace
}  // namespace fairing::test
