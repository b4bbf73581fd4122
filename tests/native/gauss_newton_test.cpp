// SPDX-License-Identifier: GPL-3.0-or-later
// The Gauss-Newton solver's parts alone: which start a level takes, and steps from there.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "curvature/error_estimate.h"
#include "curvature/start.h"
#include "curvature/steps.h"
#include "grid/linear.h"
#include "meshes.h"
#include "stencil/stencils.h"

namespace fairing::test {
namespace {

TEST(ErrorEstimate, SumsTheStepsToCome) {
  ErrorEstimate left(0.1);
  EXPECT_EQ(left.after(1, 8, true), 8);         // one step alone: as much again
  EXPECT_EQ(left.after(0.01, 0.3, true), 0.3);  // the first ratio is not believed
  EXPECT_DOUBLE_EQ(left.after(0.002, 0.06, true), 0.06 * 0.25);
  EXPECT_DOUBLE_EQ(left.after(2e-6, 0.09, true), 0.01);  // no ratio below a tenth
  EXPECT_EQ(left.after(1.9e-6, 0.5, true), 0.5);         // nor above a half
}

TEST(ErrorEstimate, AStepThatIsNotSolvedLeavesItself) {
  ErrorEstimate left(0.1);
  left.after(1, 1, true);
  left.after(0.1, 0.1, true);
  EXPECT_EQ(left.after(0.01, 0.01, false), 0.01);
}

TEST(ErrorEstimate, BeginsAnewAfterARejectedStep) {
  ErrorEstimate left(0.1);
  left.after(1, 1, true);
  left.forget();
  EXPECT_EQ(left.last_decrement(), 0);
  EXPECT_EQ(left.after(0.01, 0.5, true), 0.5);
}

// Levels 0 to 3 of an octahedron, whose vertices are given.
struct Levels {
  ControlMesh mesh = make_control_mesh(octahedron().view(), {});
  Workers workers{2};
  Monitor monitor;
  Stencils stencils = make_stencils(mesh, ChartMaker(mesh), workers);
  std::vector<GridLevel> grids;
  GaussNewtonOptions options{.step_tolerance = 1e-6, .load_tolerance = 1e-4, .solve = {}};
  std::unique_ptr<GaussNewtonSystem> system;

  Levels() {
    GridLevels levels;
    grids.reserve(4);
    for (int l = 0; l <= 3; ++l) grids.emplace_back(mesh, l);
    for (const GridLevel& grid : grids) levels.push_back(&grid);
    Unknowns unknowns;
    unknowns.vertex.assign(std::size_t(mesh.vertex_count()), 0);
    unknowns.edge.assign(mesh.edges.size(), 1);
    system = std::make_unique<GaussNewtonSystem>(mesh, levels, 1, stencils, unknowns, options,
                                                 nullptr, Mirrors{}, workers, monitor);
  }
  Array<double> polyhedron(int level) const {
    Array<double> x(3 * grids[std::size_t(level)].size());
    refine_linearly(grids[std::size_t(level)], mesh.positions, x.data());
    return x;
  }
  Array<double> sphere(int level) const {
    Array<double> x = polyhedron(level);
    for (std::size_t i = 0; i < x.size(); i += 3) Eigen::Map<Vec3>(x.data() + i).normalize();
    return x;
  }
};

TEST(Start, IsThePlateOnTheCoarsestLevel) {
  Levels levels;
  SurfaceIterate iterate{*levels.system};
  CurvatureLevelReport report;
  const Array<double> plate = levels.sphere(2);
  choose_start(iterate, 2, nullptr, plate, {}, {}, report);
  EXPECT_EQ(iterate.current.points, plate);
  EXPECT_EQ(iterate.current.version, iterate.op().linearizations());
  EXPECT_EQ(report.start_energy, report.plate_energy);
  // M is exact there: the energy is twice the area, which is less than the sphere's
  EXPECT_LT(iterate.current.energy, 8 * std::numbers::pi);
  EXPECT_GT(iterate.current.energy, 0.9 * 8 * std::numbers::pi);
}

TEST(Start, FollowsTheSolutionBelowWhereThePlateIsWorse) {
  Levels levels;
  SurfaceIterate iterate{*levels.system};
  CurvatureLevelReport below, report;
  choose_start(iterate, 2, nullptr, levels.sphere(2), {}, {}, below);
  const Array<double> bad_below = levels.polyhedron(2), bad = levels.polyhedron(3);
  choose_start(iterate, 3, nullptr, bad, bad_below, {}, report);
  EXPECT_LT(report.start_energy, 0.7 * report.plate_energy);
  double worst = 0;
  for (std::size_t i = 0; i < bad.size(); i += 3)
    worst = std::max(
        worst, std::abs(Eigen::Map<const Vec3>(iterate.current.points.data() + i).norm() - 1));
  EXPECT_LT(worst, 0.02);
}

TEST(Start, StaysThePlateWhereTheSolutionBelowIsWorse) {
  Levels levels;
  SurfaceIterate iterate{*levels.system};
  CurvatureLevelReport below, report;
  choose_start(iterate, 2, nullptr, levels.polyhedron(2), {}, {}, below);
  const Array<double> plate = levels.sphere(3);
  choose_start(iterate, 3, nullptr, plate, levels.sphere(2), {}, report);
  EXPECT_EQ(iterate.current.points, plate);
  EXPECT_NE(iterate.current.version,
            iterate.op().linearizations());  // the other candidate's is later
}

// A step to where all is flat, or from a surface that is nowhere, is none.
TEST(Steps, EndWhereNothingIsLeft) {
  Levels levels;
  SurfaceIterate iterate{*levels.system};
  CurvatureSteps steps(iterate, levels.options);
  CurvatureLevelReport report;
  choose_start(iterate, 2, nullptr, levels.sphere(2), {}, {}, report);
  steps.run_plain(nullptr, steps.accurate_end(), long_patience, report);
  EXPECT_TRUE(report.converged);
  const std::size_t count = report.steps.size();
  EXPECT_LT(count, 8);
  steps.run_plain(nullptr, steps.accurate_end(), long_patience, report);
  EXPECT_LE(report.steps.size(), count + 2);  // from there it is near

  for (double& x : iterate.current.points) x = NAN;
  iterate.linearize();
  CurvatureLevelReport nowhere;
  steps.run_plain(nullptr, steps.accurate_end(), long_patience, nowhere);
  EXPECT_TRUE(nowhere.steps.empty());
  EXPECT_FALSE(nowhere.converged);
}

// Damped ones go down, however crumpled the start; there are as many as are allowed, rejected ones
// among them.
TEST(Steps, AreShortenedUntilTheyGoDown) {
  Levels levels;
  levels.options.max_steps = 4;
  bool any_shorter = false;
  for (const double roughness : {0.1, 0.4, 0.8}) {
    SurfaceIterate iterate{*levels.system};
    CurvatureSteps steps(iterate, levels.options);
    CurvatureLevelReport report;
    Array<double> rough = levels.sphere(3);
    for (std::size_t i = 3 * std::size_t(levels.mesh.vertex_count()); i < rough.size(); ++i)
      rough[i] *= 1 + roughness * std::sin(double(i * i));
    choose_start(iterate, 3, nullptr, rough, {}, {}, report);
    const StepStart start{iterate.current.points, {}, report};
    steps.run_damped(nullptr, start, {}, report);
    EXPECT_EQ(report.last_steps, int(report.steps.size()));
    EXPECT_LE(report.steps.size(), 4);
    double energy = report.start_energy;
    for (const StepReport& step : report.steps) {
      EXPECT_LE(step.energy, 1.001 * energy) << roughness;
      energy = step.energy;
      any_shorter |= step.length < 1;
    }
    EXPECT_LT(report.energy, report.start_energy) << roughness;
  }
  EXPECT_TRUE(any_shorter);
}

}  // namespace
}  // namespace fairing::test
