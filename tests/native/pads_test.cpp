// SPDX-License-Identifier: GPL-3.0-or-later
// Pads: their hats and mass matrix, and what is left of the forces on a surface that stands on
// them.
#include "constraints/pads.h"

#include <gtest/gtest.h>

#include "fairing/systems.h"
#include "meshes.h"
#include "parallel/reductions.h"
#include "polyhedron.h"

namespace fairing::test {
namespace {

Unknowns all_but_vertices(const ControlMesh& mesh) {
  Unknowns u;
  u.vertex.assign(std::size_t(mesh.vertex_count()), 0);
  for (Index e = 0; e < Index(mesh.edges.size()); ++e) u.edge.push_back(mesh.edge_fit(e));
  return u;
}

// Omega sum f phi for these loads, three numbers a point.
std::vector<double> loaded(const Hats& hats, const Loads& loads) {
  std::vector<double> r(3 * hats.grid().size(), 0.0);
  hats.add_loads(loads, r.data());
  return r;
}

double whole_area(const ControlMesh& mesh) {
  double area = 0;
  for (const FlatFace& flat : flatten(mesh, centripetal)) area += flat.area;
  return area;
}

TEST(Pads, WideHatsAddUpToOne) {
  for (const OwnedPolygonMesh& input : {octahedron(), cube(), icosahedron()}) {
    const ControlMesh mesh = make_control_mesh(input.view(), {});
    Workers workers(2);
    Pads pads(mesh, ChartMaker(mesh), all_but_vertices(mesh), 1.0, workers);
    for (const int level : {0, 1, 3}) {
      const GridLevel grid(mesh, level);
      const Hats hats(pads, grid);
      const Loads even(std::size_t(mesh.vertex_count()), Vec3(1, 2, -3));
      const std::vector<double> r = loaded(hats, even);
      double area = 0;
      for (std::size_t i = 0; i < grid.size(); ++i) {
        EXPECT_GT(r[3 * i], 0);
        EXPECT_NEAR(r[3 * i + 1], 2 * r[3 * i], 1e-14);
        EXPECT_NEAR(r[3 * i + 2], -3 * r[3 * i], 1e-14);
        area += r[3 * i];
      }
      EXPECT_NEAR(area, whole_area(mesh), 1e-12 * area);
    }
  }
}

TEST(Pads, HatsFallOffOverTheirWidth) {
  const ControlMesh mesh = make_control_mesh(octahedron().view(), {});
  Workers workers(1);
  const GridLevel grid(mesh, 3);
  const std::size_t count = std::size_t(mesh.vertex_count());
  const Loads even(count, Vec3::Ones());
  Pads wide(mesh, ChartMaker(mesh), all_but_vertices(mesh), 1.0, workers);
  const std::vector<double> share = loaded(Hats(wide, grid), even);
  for (const double size : {0.25, 0.5, 0.75}) {
    Pads pads(mesh, ChartMaker(mesh), all_but_vertices(mesh), size, workers);
    const Hats hats(pads, grid);
    Loads one(count, Vec3::Zero());
    one[0] = Vec3::Ones();
    const std::vector<double> r = loaded(hats, one);
    double total = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) total += r[3 * i];
    EXPECT_NEAR(total, hats.total(0), 1e-14);
    EXPECT_DOUBLE_EQ(r[0], share[0]);
    for (const Spoke& spoke : mesh.ring(0))
      for (int k = 1; k < grid.n(); ++k) {
        const auto p = 3 * std::size_t(grid.edge_point(spoke.edge, spoke.outward ? k : 8 - k));
        EXPECT_NEAR(r[p] / share[p], std::max(0.0, 1 - k / 8.0 / size), 1e-14);
      }
  }
}

// K x = Omega phi f on all points off curves, control vertices included.
TEST(Pads, HoldTheSurface) {
  for (const OwnedPolygonMesh& input : {octahedron(), torus(6, 5), grid(5, 4), dodecahedron()})
    for (const double size : {0.5, 1.0}) {
      const OwnedPolygonMesh bent = waved(input, 0.3);
      FairOptions options;
      options.pad_size = size;
      options.solve.relative_residual = 1e-11;
      Monitor monitor;
      Report report;
      Stopwatch watch(report, monitor);
      const std::unique_ptr<const FairingProblem> problem =
          make_problem(bent.view(), options, watch, report);
      FairingSystems run(*problem, monitor);
      const Surface surface = run.solve(problem->basis, false, watch, report);
      const Array<double>& x = surface.plate;
      ThinPlateSolver& system = run.plate();
      ThinPlateShared& shared = system.levels().shared();
      const GridLevel& grid = run.finest();
      for (Index v = 0; v < problem->mesh.input_vertices; ++v)
        for (std::size_t a = 0; a < 3; ++a)
          EXPECT_EQ(x[3 * std::size_t(v) + a],
                    problem->basis.working[std::size_t(v)][Eigen::Index(a)]);
      std::vector<double> forces(3 * grid.size()), loads(3 * grid.size(), 0.0);
      apply_thin_plate(grid, shared.double_rows, system.pads()->rows(), {}, *problem->workers,
                       shared.double_slots, x.data(), forces.data());
      system.hats()->add_loads(surface.state.loads, loads.data());
      double largest = 0, left = 0;
      for (std::size_t i = 0; i < loads.size(); ++i) {
        largest = std::max(largest, std::abs(loads[i]));
        left = std::max(left, std::abs(forces[i] - loads[i]));
      }
      EXPECT_TRUE(report.levels.back().converged);
      EXPECT_LE(report.levels.back().pad_force, 1e-4);
      EXPECT_GT(largest, 0);
      EXPECT_LT(left, 1e-3 * largest);
    }
}

}  // namespace
}  // namespace fairing::test
