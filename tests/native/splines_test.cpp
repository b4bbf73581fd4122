// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/spline.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fairing::test {
namespace {

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

}  // namespace
}  // namespace fairing::test
