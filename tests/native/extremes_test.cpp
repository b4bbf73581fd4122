// SPDX-License-Identifier: GPL-3.0-or-later
// A solver whose rebase was stopped.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "fairing/fair.h"
#include "meshes.h"

namespace fairing::test {
namespace {

struct Rebased {
  OwnedPolygonMesh mesh = torus(6, 5), other = torus(6, 5);
  FairOptions options;
  Monitor monitor;
  std::unique_ptr<FairSolver> solver;

  explicit Rebased(Energy energy) {
    options.levels = 2;
    options.energy = energy;
    options.threads = 1;
    for (std::size_t i = 0; i < other.coordinates.size(); ++i)
      other.coordinates[i] *= 1 + 0.05 * std::sin(double(i));
    solver = std::make_unique<FairSolver>(mesh.view(), options, monitor);
  }
  // A monitor that has cancelled stays so: another one, where the solver looks for it.
  void renew_monitor() {
    std::destroy_at(&monitor);
    std::construct_at(&monitor);
  }
  std::vector<double> solve(const OwnedPolygonMesh& at) {
    std::vector<double> out(3 * solver->points());
    solver->solve(at.coordinates, out.data());
    return out;
  }
};

// The surface is of positions that are neither basis': they would not hide what is built of both.
// It is the solver's first, and so the same to the last bit.
TEST(Solver, IsAboutOneBasisWhereverARebaseIsStopped) {
  for (const Energy energy : {Energy::thin_plate, Energy::total_curvature}) {
    OwnedPolygonMesh third = Rebased(energy).mesh;
    third.coordinates[1] += 0.1;
    Rebased before(energy), after(energy);
    after.solver->rebase(after.other.view());
    const std::vector<double> of_old = before.solve(third), of_new = after.solve(third);
    ASSERT_NE(of_old, of_new);
    int stopped = 0;
    for (std::int64_t question = 1;; question += 1 + question / 12, ++stopped) {
      Rebased run(energy);
      run.monitor.cancel_at_question(question);
      bool done = true;
      try {
        run.solver->rebase(run.other.view());
      } catch (const FairingError& error) {
        EXPECT_EQ(error.code, ErrorCode::cancelled);
        done = false;
      }
      run.renew_monitor();
      EXPECT_EQ(run.solve(third), done ? of_new : of_old) << "question " << question;
      if (done) break;
    }
    EXPECT_GE(stopped, 12);
  }
}

}  // namespace
}  // namespace fairing::test
