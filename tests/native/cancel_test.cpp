// SPDX-License-Identifier: GPL-3.0-or-later
// Cancelling: parts that are left out, and runs stopped at moments all over their way.
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <vector>

#include "fairing/fair.h"
#include "meshes.h"
#include "parallel/reductions.h"
#include "parallel/workers.h"
#include "thrown.h"

namespace fairing::test {
namespace {

constexpr std::size_t size = 1000;

// How often each index is visited.
std::vector<int> visits(Workers& workers, std::size_t count, std::size_t grain) {
  std::vector<int> seen(count, 0);
  workers.for_each(count, grain, [&](std::size_t i) { ++seen[i]; });
  return seen;
}

TEST(Workers, visit_every_index_once) {
  for (const int threads : {1, 3}) {
    Workers workers(threads);
    for (const std::size_t count : {0, 1, 2, 255, 256, 257, 1000, 100000})
      for (const std::size_t grain : {0, 1, 7, 300})
        EXPECT_EQ(visits(workers, count, grain), std::vector<int>(count, 1))
            << count << " by " << grain;
  }
}

// Each thread may have begun one part before it could know.
TEST(Workers, stop_between_parts) {
  for (const int threads : {1, 3}) {
    Workers workers(threads);
    for (const int last : {1, 2, 50}) {
      Monitor monitor;
      const CancelScope scope(&monitor);
      std::atomic<int> begun{0};
      EXPECT_EQ(thrown([&] {
                  workers.for_parts(size, 1, [&](std::size_t, std::size_t) {
                    if (++begun >= last) monitor.cancel();
                  });
                }).code,
                ErrorCode::cancelled);
      EXPECT_GE(begun.load(), last);
      EXPECT_LT(begun.load(), last + threads);
    }
    EXPECT_EQ(visits(workers, size, 1), std::vector<int>(size, 1));
  }
}

TEST(Workers, rethrow_the_first_failure_and_leave_out_the_rest) {
  for (const int threads : {1, 3}) {
    Workers workers(threads);
    std::atomic<int> begun{0};
    EXPECT_THROW(workers.for_parts(size, 1,
                                   [&](std::size_t, std::size_t) {
                                     ++begun;
                                     throw std::bad_alloc();
                                   }),
                 std::bad_alloc);
    EXPECT_LE(begun.load(), threads);
    EXPECT_EQ(visits(workers, size, 1), std::vector<int>(size, 1));
  }
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
  return out;
}

std::vector<Job> jobs() {
  std::vector<Job> all{{"large faces", icosahedron(), options(4, Energy::thin_plate)},
                       {"small faces", torus(12, 10), options(2, Energy::thin_plate)},
                       {"polygons", dodecahedron(), options(2, Energy::thin_plate)},
                       {"curvature", cube(), options(3, Energy::total_curvature)},
                       {"curvature, small faces", torus(6, 5), options(2, Energy::total_curvature)},
                       {"variation", octahedron(), options(2, Energy::minimum_variation)}};
  FairOptions region = options(2, Energy::thin_plate);
  region.features.region = {true, {0, 1, 2, 3, 4, 8, 9, 10}, RegionContinuity::tangent};
  all.push_back({"region", torus(8, 6), region});
  return all;
}

// At the first question, the second, …, ever farther apart until the run is over: each time it ends
// as cancelled, and the next run knows nothing of it.
TEST(Cancel, stops_a_run_anywhere_and_leaves_nothing_behind) {
  for (Job& job : jobs())
    for (const int threads : {1, 3}) {
      job.options.threads = threads;
      Monitor undisturbed;
      const FairResult expected = fair(job.mesh.view(), job.options, undisturbed);
      std::set<Phase> phases;
      int stopped = 0;
      for (std::int64_t question = 1;; question += 1 + question / 2, ++stopped) {
        Monitor monitor;
        monitor.cancel_at_question(question);
        try {
          const FairResult result = fair(job.mesh.view(), job.options, monitor);
          EXPECT_EQ(result.vertices, expected.vertices) << job.name;
          break;
        } catch (const FairingError& error) {
          ASSERT_EQ(error.code, ErrorCode::cancelled) << job.name;
          phases.insert(monitor.phase());
        }
        if (stopped % 3 != 0) continue;
        Monitor next;
        EXPECT_EQ(fair(job.mesh.view(), job.options, next).vertices, expected.vertices) << job.name;
      }
      EXPECT_GE(stopped, 12) << job.name;
      EXPECT_TRUE(phases.contains(Phase::check) && phases.contains(Phase::solve)) << job.name;
    }
}

}  // namespace
}  // namespace fairing::test
