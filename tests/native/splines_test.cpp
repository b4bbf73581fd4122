// SPDX-License-Identifier: GPL-3.0-or-later
// Spline patches against surfaces that are known: a bicubic comes back, a sphere is met within the
// tolerance, curves are refined and cut exactly.
#include "splines/fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "refined_surfaces.h"

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
