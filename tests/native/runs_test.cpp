// SPDX-License-Identifier: GPL-3.0-or-later
// The iterator over vertices, edge runs and face rows, and sums over it, against the numbering of
// points and rings written out.
#include "grid/runs.h"

#include <gtest/gtest.h>

#include "grid/accumulate.h"
#include "mesh/control_mesh.h"
#include "meshes.h"
#include "random.h"

namespace fairing::test {
namespace {

// Triangles and quads, a boundary, valences 1 to 8.
ControlMesh mixed_mesh() {
  OwnedPolygonMesh mesh = fan(8);
  const auto corner = [&](double x, double y) {
    mesh.coordinates.insert(mesh.coordinates.end(), {x, y, 0.25});
    return std::int64_t(mesh.coordinates.size()) / 3 - 1;
  };
  const std::int64_t a = corner(3, 0), b = corner(3, 2);
  mesh.corners.insert(mesh.corners.end(), {1, a, b, 2});
  mesh.offsets.push_back(std::int64_t(mesh.corners.size()));
  return make_control_mesh(mesh.view(), {});
}

std::vector<std::vector<Index>> rings(const GridLevel& grid) {
  std::vector<std::vector<Index>> out(grid.size());
  for_each_run(grid, [&](const auto& run) {
    for (std::size_t i = 0; i < run.count; ++i) append_ring(grid, run, i, out[run.first + i]);
  });
  return out;
}

std::vector<double> random_numbers(std::size_t size) {
  std::mt19937 random(5);
  UniformReal<> number(-1, 1);
  std::vector<double> out(size);
  for (double& x : out) x = number(random);
  return out;
}

class RunsOnLevel : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Levels, RunsOnLevel, testing::Values(0, 1, 2, 3));

TEST_P(RunsOnLevel, CoverAllPointsInTheirOrder) {
  const ControlMesh mesh = mixed_mesh();
  const GridLevel grid(mesh, GetParam());
  std::size_t next = 0;
  for_each_run(grid, [&](const auto& run) {
    EXPECT_EQ(run.first, next);
    ASSERT_GT(run.count, 0u);
    const Index last = Index(run.first + run.count - 1);
    if (run.kind == RunKind::edge) {
      EXPECT_EQ(grid.edge_point(run.element, int(run.count)), last);
    } else if (run.kind == RunKind::face_row) {
      EXPECT_EQ(grid.face_point(run.element, int(run.count), run.row), last);
    }
    next += run.count;
  });
  EXPECT_EQ(next, grid.size());
}

TEST_P(RunsOnLevel, AreVisitedOnceByAnyNumberOfThreads) {
  const ControlMesh mesh = mixed_mesh();
  const GridLevel grid(mesh, GetParam());
  for (const int threads : {1, 3}) {
    Workers workers(threads);
    std::vector<int> visits(grid.size(), 0);
    for_each_run(grid, workers, [&](const auto& run) {
      for (std::size_t i = 0; i < run.count; ++i) ++visits[run.first + i];
    });
    EXPECT_EQ(visits, std::vector<int>(grid.size(), 1));
  }
}

TEST_P(RunsOnLevel, ReadTheirNeighboursInTheOrderOfTheRing) {
  const ControlMesh mesh = mixed_mesh();
  const GridLevel grid(mesh, GetParam());
  const auto ring = rings(grid);
  const std::vector<double> x = random_numbers(3 * grid.size());
  Workers workers(3);
  for_each_run(
      grid, workers, [&] { return RunGather<double, 3>(grid, x.data()); },
      [&](const auto& run, RunGather<double, 3>& gather) {
        const double* const* slot = gather(run);
        for (std::size_t i = 0; i < run.count; ++i) {
          const std::size_t p = run.first + i;
          for (std::size_t s = 0; s <= ring[p].size(); ++s) {
            const std::size_t q = s == 0 ? p : std::size_t(ring[p][s - 1]);
            for (std::size_t a = 0; a < 3; ++a) EXPECT_EQ(slot[s][3 * i + a], x[3 * q + a]);
          }
        }
      });
}

// Σ over the points p of x_p (s + 1) at the member of slot s of p's ring.
TEST_P(RunsOnLevel, AccumulateWhatTheyAddToTheirNeighbours) {
  const ControlMesh mesh = mixed_mesh();
  const GridLevel grid(mesh, GetParam());
  const auto ring = rings(grid);
  const std::vector<double> x = random_numbers(grid.size());
  std::vector<double> expected(grid.size(), 0.0), first;
  for (std::size_t p = 0; p < grid.size(); ++p) {
    expected[p] += x[p];
    for (std::size_t s = 0; s < ring[p].size(); ++s)
      expected[std::size_t(ring[p][s])] += double(s + 2) * x[p];
  }
  for (const int threads : {1, 3}) {
    Workers workers(threads);
    ElementSlots<double, 1> slots;
    std::vector<double> out(grid.size());
    accumulate_runs(
        grid, workers, slots, nullptr, out.data(), [] { return 0; },
        [&](const auto& run, double* const* target, int) {
          for (std::size_t i = 0; i < run.count; ++i)
            for (std::size_t s = 0; s <= ring[run.first + i].size(); ++s)
              target[s][i] += double(s + 1) * x[run.first + i];
        });
    for (std::size_t p = 0; p < grid.size(); ++p) EXPECT_NEAR(out[p], expected[p], 1e-12);
    if (first.empty()) first = out;
    EXPECT_EQ(out, first) << "of " << threads << " threads";
  }
}

TEST_P(RunsOnLevel, SumByElement) {
  const ControlMesh mesh = mixed_mesh();
  const GridLevel grid(mesh, GetParam());
  ElementSums sums(mesh);
  for_each_run(grid, [&](const auto& run) { sums.of(run) += double(run.count); });
  EXPECT_EQ(sums.total(), double(grid.size()));
  EXPECT_EQ(sums.vertex(0), 1);
  EXPECT_EQ(sums.edge(0), grid.n() - 1);
  const Index quad = Index(mesh.faces.size()) - 1;
  EXPECT_EQ(sums.face(0), double(interior_size(false, grid.n())));
  EXPECT_EQ(sums.face(quad), double(interior_size(true, grid.n())));
}

}  // namespace
}  // namespace fairing::test
