// SPDX-License-Identifier: GPL-3.0-or-later
// An allocation of a small run fails, the first, the second, … ever farther apart until the run
// goes through: each time there is one error with a name, or the surface; nothing leaks, and the
// next run knows nothing of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "allocations.h"
#include "fairing/fair.h"
#include "meshes.h"

namespace fairing::test {
namespace {

// Runs a body on a thread of its own, whose buffers go with it, and checks that nothing stays.
template <class Body>
void without_leaks(Body&& body) {
  const std::int64_t before = live_allocations();
  std::thread(body).join();
  EXPECT_EQ(live_allocations(), before);
}

// All of the first ones, then ever fewer: most kinds of allocations come early in some phase.
std::int64_t after(std::int64_t n) { return n + 1 + n / 24; }

// The code of the error of a call whose n-th allocation fails; none: it went through. `enough` is
// set where there were not so many.
std::optional<ErrorCode> outcome(std::int64_t n, bool& enough, const std::function<void()>& call) {
  const FailingAllocation failing(n);
  std::optional<ErrorCode> code;
  try {
    call();
  } catch (const FairingError& error) {
    code = error.code;
  }
  enough = failing.count() < n;
  return code;
}

struct Job {
  const char* name;
  OwnedPolygonMesh mesh;
  FairOptions options;
};

FairOptions options(int levels, Energy energy) {
  FairOptions out;
  out.levels = levels;
  out.energy = energy;
  out.max_steps = 4;
  return out;
}

std::vector<Job> jobs() {
  std::vector<Job> all{
      {"plate", cube(), options(2, Energy::thin_plate)},
      {"plate with matrices", torus(6, 5), options(2, Energy::thin_plate)},
      {"polygons", dodecahedron(), options(1, Energy::thin_plate)},
      {"steps", octahedron(), options(2, Energy::total_curvature)},
      {"steps on a torus", torus(5, 4), options(1, Energy::total_curvature)},
      {"variation", octahedron(), options(1, Energy::minimum_variation)},
  };
  FairOptions near = options(1, Energy::thin_plate);
  near.interpolation = Interpolation::approximate;
  near.tolerance = {0.05};
  all.push_back({"tolerance", icosahedron(), near});
  FairOptions region = options(1, Energy::thin_plate);
  region.features.region = {true, {0, 1, 2, 3, 4, 8, 9, 10}, RegionContinuity::tangent};
  all.push_back({"region", torus(8, 6), region});
  FairOptions taut = options(1, Energy::total_curvature);
  taut.membrane.tension = 0.5;
  taut.pad_size = 0;
  all.push_back({"tension", cube_triangles(), taut});
  FairOptions back_leg = options(2, Energy::thin_plate);
  back_leg.paper.method = Method::back_leg;
  all.push_back({"back leg", cube(), back_leg});
  return all;
}

TEST(Faults, end_a_run_with_a_name_and_leave_nothing) {
  for (Job& job : jobs())
    for (const int threads : {1, 2}) {
      job.options.threads = threads;
      Array<double> expected;
      const auto run = [&] {
        Monitor monitor;
        return fair(job.mesh.view(), job.options, monitor).vertices;
      };
      std::thread([&] { expected = run(); }).join();
      int failures = 0;
      bool enough = false;
      for (std::int64_t n = 1; !enough; n = after(n))
        without_leaks([&] {
          Array<double> vertices;
          const auto code = outcome(n, enough, [&] { vertices = run(); });
          failures += code.has_value();
          EXPECT_EQ(code.value_or(ErrorCode::out_of_memory), ErrorCode::out_of_memory)
              << job.name << ", allocation " << n;
          if (!code || n % 4 == 0) {
            EXPECT_EQ(code ? run() : vertices, expected) << job.name << ", allocation " << n;
          }
        });
      EXPECT_GT(failures, 50) << job.name;
    }
}

// The same mesh with a corner moved.
OwnedPolygonMesh moved(OwnedPolygonMesh mesh) {
  mesh.coordinates[0] *= 1.2;
  mesh.coordinates[4] += 0.1;
  return mesh;
}

struct SolverRun {
  const OwnedPolygonMesh mesh, other;
  Monitor monitor{};
  FairSolver solver;
  std::vector<double> surface;  // room for it
  bool warm = false;            // whether the last solve started from an earlier one

  SolverRun(const OwnedPolygonMesh& m, const FairOptions& options)
      : mesh(m),
        other(moved(m)),
        solver(mesh.view(), options, monitor),
        surface(3 * solver.points()) {}

  const std::vector<double>& solve(const OwnedPolygonMesh& at) {
    warm = solver.solve(at.coordinates, surface.data()).warm;
    return surface;
  }
};

std::vector<Job> solver_jobs() {
  return {{"plate", torus(6, 5), options(2, Energy::thin_plate)},
          {"steps", octahedron(), options(1, Energy::total_curvature)}};
}

// Of a solver that has solved once, `call` fails; `then` looks at it, with the surface of a new one.
// Returns the fewest failures of a job.
int fails_in(const std::function<void(SolverRun&)>& call,
             const std::function<void(SolverRun&, const std::vector<double>&)>& then) {
  int fewest = std::numeric_limits<int>::max();
  for (Job& job : solver_jobs()) {
    job.options.threads = 1;
    std::vector<double> expected;
    std::thread([&] { expected = SolverRun(job.mesh, job.options).solve(job.mesh); }).join();
    int failures = 0;
    bool enough = false;
    for (std::int64_t n = 1; !enough; n = after(n))
      without_leaks([&] {
        SCOPED_TRACE(std::string(job.name) + ", allocation " + std::to_string(n));
        SolverRun run(job.mesh, job.options);
        run.solve(job.mesh);
        const auto code = outcome(n, enough, [&] { call(run); });
        if (!code) return;
        ++failures;
        EXPECT_EQ(*code, ErrorCode::out_of_memory);
        run.solve(job.mesh);
        then(run, expected);
      });
    fewest = std::min(fewest, failures);
  }
  return fewest;
}

TEST(Faults, of_a_solve_leave_a_solver_that_starts_from_nothing) {
  EXPECT_GT(
      fails_in([](SolverRun& run) { run.solve(run.other); },
               [](SolverRun& run, const auto& expected) { EXPECT_EQ(run.surface, expected); }),
      10);
}

// While it looks at the new positions, nothing has changed, and the old surface is a start.
TEST(Faults, of_a_rebase_leave_the_solver_where_it_was) {
  EXPECT_GT(fails_in([](SolverRun& run) { run.solver.rebase(run.other.view()); },
                     [](SolverRun& run, const auto& expected) {
                       for (std::size_t i = 0; i < expected.size(); ++i)
                         ASSERT_NEAR(run.surface[i], expected[i], run.warm ? 1e-6 : 0.0);
                     }),
            50);
}

TEST(Faults, of_a_construction_leave_nothing) {
  for (Job& job : solver_jobs()) {
    job.options.threads = 2;
    bool enough = false;
    for (std::int64_t n = 1; !enough; n = after(n))
      without_leaks([&] {
        Monitor monitor;
        std::optional<FairSolver> solver;
        const auto code =
            outcome(n, enough, [&] { solver.emplace(job.mesh.view(), job.options, monitor); });
        EXPECT_EQ(code.value_or(ErrorCode::out_of_memory), ErrorCode::out_of_memory)
            << job.name << ", allocation " << n;
      });
  }
}

}  // namespace
}  // namespace fairing::test
