// SPDX-License-Identifier: GPL-3.0-or-later
// A fit of spline patches holds, beside the surface it reads and the patches it returns, the data
// of one patch for each thread, and a little for each edge.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "allocations.h"
#include "refined_surfaces.h"
#include "splines/fit.h"

namespace fairing::test {
namespace {

struct Held {
  std::int64_t surface, patches, peak;  // bytes
};

enum class Patches { one_a_face, one };

Held of_fit(int columns, int levels, int threads, Patches patches = Patches::one_a_face) {
  const Refined surface = strip(columns, levels, [](double u, double v) {
    return Vec3(u, v, 0.1 * std::sin(u) * std::cos(v));
  });
  std::vector<std::int32_t> groups(columns);
  if (patches == Patches::one_a_face) std::iota(groups.begin(), groups.end(), 0);
  const std::int64_t before = live_bytes();
  restart_peak();
  Monitor monitor;
  const SplineSurface fitted = fit_splines(surface.view(), {1e-4, 8e-4, threads, groups}, monitor);
  EXPECT_EQ(fitted.patches.size(), patches == Patches::one ? 1u : std::size_t(columns));
  return {std::int64_t(surface.vertices.size() * sizeof(double) +
                       surface.quads.size() * sizeof(std::int32_t)),
          live_bytes() - before, peak_bytes() - before};
}

class SplineMemory : public testing::Test {
 protected:
  void SetUp() override {
    of_fit(1, 3, 1);  // what the first run keeps
    if (peak_bytes() == 0) GTEST_SKIP() << "bytes are not counted on this system";
  }
};

TEST_F(SplineMemory, WorksOnOnePatchAtATime) {
  const Held one = of_fit(1, 6, 1), few = of_fit(4, 6, 1), many = of_fit(16, 6, 1);
  const std::int64_t a_face = (many.surface - few.surface) / 12;
  // more faces take their patches and what is known of their edges
  const std::int64_t more = (many.peak - many.patches) - (few.peak - few.patches);
  EXPECT_LT(more, 12 * a_face / 10);
  // samples of a face, twice: position, normal, parameters
  EXPECT_LT(one.peak - one.patches, 5 * a_face);
}

TEST_F(SplineMemory, HoldsTheSamplesOfAPatchOfManyFaces) {
  const Held held = of_fit(16, 6, 1, Patches::one);
  EXPECT_LT(held.peak - held.patches, 5 * held.surface);
}

TEST_F(SplineMemory, HoldsAPatchForEachThread) {
  const Held one = of_fit(16, 6, 1), four = of_fit(16, 6, 4);
  const std::int64_t a_face = one.surface / 16;
  EXPECT_LT(four.peak, one.peak + 3 * 5 * a_face);
}

}  // namespace
}  // namespace fairing::test
