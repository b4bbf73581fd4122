// SPDX-License-Identifier: GPL-3.0-or-later
// Points of a run together against the same points one by one.
#include <gtest/gtest.h>

#include <cmath>

#include "curvature/rings.h"
#include "meshes.h"
#include "polyhedron.h"
#include "random.h"

namespace fairing::test {
namespace {

constexpr int level = 3;

Array<double> lumpy(const GridLevel& lattice) {
  Array<double> x(3 * lattice.size());
  refine_linearly(lattice, lattice.mesh().positions, x.data());
  std::mt19937 random(7);
  UniformReal<> shake(-0.01, 0.01);
  for (double& number : x) number = number * (1 + 0.2 * std::sin(5 * number)) + shake(random);
  return x;
}

Array<float> some_lifts(const GridLevel& lattice) {
  Array<float> lift(lattice.size());
  std::mt19937 random(11);
  UniformReal<float> share(-1, 1);
  for (float& l : lift) l = std::max(0.0f, share(random));
  return lift;
}

void expect_lane(const CurvatureLanes& pack, std::size_t lane, const ShapeRows& one,
                 const Vec3& axis) {
  const auto near = [&](const Vec3& expected, const double (&found)[3][lane_count],
                        const char* what) {
    SCOPED_TRACE(what);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found[c][lane], expected[c], 1e-9 * (1 + expected.norm()));
  };
  EXPECT_NEAR(pack.area[lane], one.point.area, 1e-12);
  near(one.point.normal, pack.normal, "normal");
  near(one.shape, pack.shape, "shape");
  near(one.own, pack.row[0], "own row");
  near(axis, pack.axis, "axis");
  for (std::size_t j = 0; j < one.row.size(); ++j) {
    near(one.row[j], pack.row[j + 1], "row");
    EXPECT_NEAR(pack.cotangent[j + 1][lane], one.chart.cotangent[j], 1e-10);
  }
}

// Returns how many points have been compared.
std::size_t compare(const RunRings& rings, std::size_t count, CurvatureEnergy energy) {
  CurvatureLanes pack;
  ShapeRows one;
  RingInSpace ring;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < count; i += lane_count) {
    linearize(rings, i, energy, true, pack);
    for (std::size_t lane = 0; lane < lane_count && i + lane < count; ++lane) {
      if (!pack.done[lane]) continue;
      ring_at(rings, i + lane, ring);
      const SurfaceRing view = ring.view(true);
      linearize(view, energy, one);
      expect_lane(pack, lane, one, chart_axis(one.point.normal, one.chart));
      ++compared;
    }
  }
  return compared;
}

TEST(CurvatureLanes, DoWhatSinglePointsDo) {
  for (const CurvatureEnergy energy :
       {CurvatureEnergy::total_curvature, CurvatureEnergy::minimum_variation})
    for (const auto& [name, control] : {std::pair{"octahedron", octahedron()}, {"cube", cube()}})
      for (const bool lifted : {false, true}) {
        SCOPED_TRACE(std::string(name) + (lifted ? ", lifted" : ""));
        const ControlMesh mesh = make_control_mesh(control.view(), {});
        const GridLevel lattice(mesh, level);
        const Array<double> x = lumpy(lattice);
        const Array<float> lifts = some_lifts(lattice);
        const float* lift = lifted ? lifts.data() : nullptr;
        RingLanes rings(lattice, x.data(), lift);
        std::size_t points = 0, compared = 0;
        for_each_run(lattice, [&](const auto& run) {
          if (run.kind == RunKind::vertex) return;
          points += run.count;
          compared += compare(rings(run), run.count, energy);
        });
        EXPECT_GT(compared, points * 9 / 10);
      }
}

}  // namespace
}  // namespace fairing::test
