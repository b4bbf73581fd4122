// SPDX-License-Identifier: GPL-3.0-or-later
// The Gauss-Newton solver's parts alone: the step loop on a problem in one variable, and which start
// a level takes.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "curvature/left_to_move.h"
#include "curvature/start.h"
#include "curvature/steps.h"
#include "grid/linear.h"
#include "meshes.h"
#include "stencil/stencils.h"

namespace fairing::test {
namespace {

TEST(LeftToMove, SumsTheStepsToCome) {
  LeftToMove left(0.1);
  EXPECT_EQ(left.after(1, 8, true), 8);         // one step alone: as much again
  EXPECT_EQ(left.after(0.01, 0.3, true), 0.3);  // the first ratio is not believed
  EXPECT_DOUBLE_EQ(left.after(0.002, 0.06, true), 0.06 * 0.25);
  EXPECT_DOUBLE_EQ(left.after(2e-6, 0.09, true), 0.01);  // no ratio below a tenth
  EXPECT_EQ(left.after(1.9e-6, 0.5, true), 0.5);         // nor above a half
}

TEST(LeftToMove, AStepThatIsNotSolvedLeavesItself) {
  LeftToMove left(0.1);
  left.after(1, 1, true);
  left.after(0.1, 0.1, true);
  EXPECT_EQ(left.after(0.01, 0.01, false), 0.01);
}

TEST(LeftToMove, BeginsAnewAfterARejectedStep) {
  LeftToMove left(0.1);
  left.after(1, 1, true);
  left.forget();
  EXPECT_EQ(left.last_decrement(), 0);
  EXPECT_EQ(left.after(0.01, 0.5, true), 0.5);
}

// Minimizes (x - target)^2 by steps that are `stretch` times the right one.
class Parabola final : public StepMethod {
 public:
  double x = 0, target = 1, stretch = 1;
  bool goes_on_after_rejection = true;
  std::vector<int> rejected_before;  // as each full step saw it

  bool begin(CurvatureLevelReport& report) override {
    report.converged = energy(x) < 1e-12;
    return !report.converged;
  }
  void find_step(StepReport& step) override {
    direction_ = stretch * (target - x);
    step.energy = energy(x);
  }
  double try_length(StepReport& step, const StepCount& count) override {
    if (step.length == 1) rejected_before.push_back(count.rejected);
    trial_ = x + step.length * direction_;
    step.movement = std::abs(trial_ - x);
    return energy(trial_);
  }
  bool is_acceptable(const StepReport& step, double energy) const override {
    return energy < step.energy;
  }
  bool accept(const StepReport& step, const StepCount& count, CurvatureLevelReport&) override {
    x = trial_;
    accepted = count.accepted;
    return step.movement < smallest;
  }
  bool reject() override {
    stretch /= shrink;
    return goes_on_after_rejection;
  }

  int accepted = 0;
  double smallest = 0, shrink = 4;

 private:
  double energy(double at) const { return (at - target) * (at - target); }
  double direction_ = 0, trial_ = 0;
};

TEST(StepLoop, EndsWhereNothingIsLeft) {
  Parabola method;
  CurvatureLevelReport report;
  run_steps(method, 10, report);
  EXPECT_EQ(method.x, 1);
  EXPECT_TRUE(report.converged);
  ASSERT_EQ(report.steps.size(), 1);
  EXPECT_EQ(report.steps[0].length, 1);
}

TEST(StepLoop, HalvesStepsThatAreTooLong) {
  Parabola method;
  method.stretch = 3;  // half of it gains, all of it does not
  method.smallest = 10;
  CurvatureLevelReport report;
  run_steps(method, 10, report);
  ASSERT_EQ(report.steps.size(), 1);  // the first one is as small as was asked
  EXPECT_EQ(report.steps[0].length, 0.5);
  EXPECT_EQ(method.x, 1.5);
}

TEST(StepLoop, TriesAgainWhereNoLengthWillDo) {
  Parabola method;
  method.stretch =
      40;  // an eighth of it is five times too long; after a quarter of that it will do
  CurvatureLevelReport report;
  run_steps(method, 3, report);
  ASSERT_EQ(report.steps.size(), 3);
  EXPECT_EQ(report.steps[0].length, 0);
  EXPECT_EQ(report.steps[1].length, 0.125);
  EXPECT_EQ(method.rejected_before, (std::vector<int>{0, 1, 1}));
  EXPECT_EQ(method.accepted, 2);
  EXPECT_EQ(method.x, 0.9375);
}

TEST(StepLoop, GivesUp) {
  Parabola uphill;
  uphill.stretch = -1;
  CurvatureLevelReport report;
  run_steps(uphill, 10, report);
  EXPECT_EQ(report.steps.size(), 10);  // rejections
  EXPECT_EQ(uphill.x, 0);
  EXPECT_FALSE(report.converged);

  Parabola once;
  once.stretch = -1;
  once.goes_on_after_rejection = false;
  CurvatureLevelReport of_one;
  run_steps(once, 10, of_one);
  EXPECT_EQ(of_one.steps.size(), 1);
}

TEST(StepLoop, TakesAtMostSoManySteps) {
  Parabola method;
  method.stretch = 0.5;
  CurvatureLevelReport report;
  run_steps(method, 3, report);
  EXPECT_EQ(report.steps.size(), 3);
  EXPECT_EQ(method.x, 0.875);
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
    std::vector<CurvatureGrid> levels;
    grids.reserve(4);
    for (int l = 0; l <= 3; ++l) grids.emplace_back(mesh, l);
    for (const GridLevel& grid : grids) levels.push_back({&grid, nullptr});
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
  EXPECT_EQ(iterate.current.number, iterate.op().linearizations());
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
  EXPECT_NE(iterate.current.number,
            iterate.op().linearizations());  // the other candidate's is later
}

}  // namespace
}  // namespace fairing::test
