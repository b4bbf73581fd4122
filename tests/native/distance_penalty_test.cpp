// SPDX-License-Identifier: GPL-3.0-or-later
// The penalty on the distance from a reference beside a curvature energy: energy, force, matrix.
#include <gtest/gtest.h>

#include "curvature/level.h"
#include "level_settings.h"
#include "polyhedron.h"

namespace fairing::test {
namespace {

constexpr CurvatureEnergy energies[] = {CurvatureEnergy::total_curvature,
                                        CurvatureEnergy::minimum_variation};

Array<double> lumpy(const GridLevel& grid) {
  Array<double> x(3 * grid.size());
  refine_linearly(grid, grid.mesh().positions, x.data());
  const Points shake = random_points(grid.size(), 4);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 0.2 / grid.n() * shake.data()[i];
  return x;
}

// A level with a penalty about a lumpy surface, on a reference beside it.
struct Penalized {
  Penalized(const ControlMesh& mesh, int level, CurvatureEnergy of)
      : grid(mesh, level), shared{mesh, some_points(mesh, 1), workers}, energy(of), x(lumpy(grid)) {
    Reference reference{x, Array<float>(grid.size(), 1.5f)};
    for (std::size_t i = 0; i < x.size(); ++i) reference.points[i] += 0.01 * double(i % 7);
    shared.ends_in_variation = varies();
    alone = without_penalty.linearize(x.data(), {energy}, &without);
    system.linearize(x.data(), {}, &at_first);
    system.penalize(reference, x.data(), at_first);
    objective = system.objective();
    whole = system.linearize(x.data(), {energy}, &with);
  }

  bool varies() const { return energy == CurvatureEnergy::minimum_variation; }

  Workers workers{2};
  GridLevel grid;
  CurvatureShared shared;
  CurvatureEnergy energy;
  Array<double> x;
  CurvatureLevel system{shared, grid}, without_penalty{shared, grid};
  Linearization without{}, at_first{}, with{};
  double alone = 0, objective = 0, whole = 0;
};

// The penalty is quadratic, so differences on both sides give its slope.
TEST(DistancePenalty, ForceIsMinusHalfTheSlope) {
  for (const CurvatureEnergy energy : energies)
    for (const char* name : {"cube", "icosahedron", "mixed grid"}) {
      SCOPED_TRACE(name);
      Penalized at(all_meshes().at(name), 2, energy);
      const DistancePenalty& penalty = *at.system.penalty();
      EXPECT_NEAR(at.whole - at.alone, penalty.energy(at.x.data(), at.varies(), at.workers),
                  1e-9 * at.whole);
      const std::vector<std::uint8_t> unknown = unknown_points(at.grid, at.shared.unknowns);
      bool any = false;
      for (std::size_t p = 0; p < at.grid.size(); ++p) {
        const auto moved = [&](double step) {
          Array<double> y = at.x;
          for (std::size_t a = 0; a < 3; ++a) y[3 * p + a] += step * at.with.normal[3 * p + a];
          return penalty.energy(y.data(), at.varies(), at.workers);
        };
        const double slope = (moved(0.1) - moved(-0.1)) / 0.2;
        EXPECT_NEAR(at.with.force[p] - at.without.force[p], -slope / 2, 1e-8 * at.whole) << p;
        any |= slope != 0;
        if (!unknown[p]) {
          EXPECT_EQ(penalty.weight(p, at.varies()), 0) << p;
        }
      }
      EXPECT_TRUE(any);
    }
}

TEST(DistancePenalty, IsAddedToTheLinearizationThatItsWeightsAreFrom) {
  const Penalized at(all_meshes().at("mixed grid"), 2, CurvatureEnergy::total_curvature);
  EXPECT_EQ(at.objective, at.whole);
  EXPECT_EQ(at.at_first.force, at.with.force);
}

// Waves that the penalty outweighs: (A + Q) (S + D)^-1 (A + Q) is about Q^2 / D there.
TEST(DistancePenalty, IsInBothMatricesOfTheCyclesOfVariation) {
  Penalized at(all_meshes().at("mixed grid"), 2, CurvatureEnergy::minimum_variation);
  const std::size_t points = at.grid.size();
  const Points h = masked(at.grid, at.shared.unknowns, random_points(points));
  Array<float> in(points + vector_room), a(in.size()), s(in.size()), a_alone(in.size()),
      s_alone(in.size());
  for (std::size_t p = 0; p < points; ++p) in[p] = float(h(Eigen::Index(p), 0));
  const DistancePenalty penalty = *at.system.penalty();
  at.system.apply(in.data(), a.data());
  at.system.apply_between(in.data(), s.data());
  at.without_penalty.apply(in.data(), a_alone.data());
  at.without_penalty.apply_between(in.data(), s_alone.data());
  bool any = false;
  for (std::size_t p = 0; p < points; ++p) {
    const double q = penalty.in_cycles(p), d = penalty.between(p);
    EXPECT_NEAR(a[p], double(a_alone[p]) + q * in[p], 1e-5 * (1 + std::abs(a[p]))) << p;
    EXPECT_NEAR(s[p], double(s_alone[p]) + d * in[p], 1e-5 * (1 + std::abs(s[p]))) << p;
    EXPECT_NEAR(q * q, d * penalty.weight(p, true), 1e-6 * q * q) << p;
    any |= q * std::abs(in[p]) > 1e-3 * std::abs(a[p]) && d > 0;
  }
  EXPECT_TRUE(any);
}

}  // namespace
}  // namespace fairing::test
