// SPDX-License-Identifier: GPL-3.0-or-later
// Couples: where they act, which slopes they see, and what is left on a surface whose normals they
// hold.
#include "constraints/couples.h"

#include <gtest/gtest.h>

#include "fairing/systems.h"
#include "grid/linear.h"
#include "meshes.h"

namespace fairing::test {
namespace {

std::vector<FixedNormal> upright(const ControlMesh& mesh) {
  std::vector<FixedNormal> out;
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.vertex_fit(v)) out.push_back({v, Vec3::UnitZ()});
  return out;
}

std::vector<double> coupled(const LevelCouples& couples, const Moments& moments) {
  std::vector<double> r(3 * couples.grid().size(), 0.0);
  couples.add(moments, r.data());
  return r;
}

TEST(Couples, PushNothing) {
  const ControlMesh mesh = make_control_mesh(grid(4, 4).view(), {});
  Workers workers(2);
  const Couples couples(mesh, ChartMaker(mesh), upright(mesh), workers);
  ASSERT_EQ(couples.size(), 9u);
  for (const int level : {1, 2, 4}) {
    const GridLevel grid(mesh, level);
    Moments one(9, Vec2::Zero());
    one[4] = Vec2(1, 0.5);
    const std::vector<double> r = coupled({couples, grid}, one);
    double sum = 0, size = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      EXPECT_EQ(r[3 * i], 0);
      EXPECT_EQ(r[3 * i + 1], 0);
      sum += r[3 * i + 2];
      size += std::abs(r[3 * i + 2]);
    }
    EXPECT_GT(size, 0);
    EXPECT_NEAR(sum, 0, 1e-14);
    for (Index v = 0; v < mesh.vertex_count(); ++v) EXPECT_EQ(r[3 * std::size_t(v) + 2], 0);
  }
}

// K x = Omega (phi f + psi m n) on all points off curves, and the normals are those asked for.
TEST(Couples, HoldTheNormals) {
  for (const OwnedPolygonMesh& input : {octahedron(), torus(6, 5), grid(5, 4)})
    for (const double size : {0.0, 1.0}) {
      const OwnedPolygonMesh bent = waved(input, 0.2);
      FairOptions options;
      options.pad_size = size;
      options.solve.relative_residual = 1e-11;
      options.normals.assign(bent.coordinates.size(), NAN);
      const ControlMesh control = make_control_mesh(bent.view(), {});
      const std::size_t vertex = input.coordinates.size() == 18 ? 1 : 9;
      Vec3 own = Vec3::Zero();
      for (const Spoke& spoke : control.ring(Index(vertex))) {
        const Face& face = control.faces[std::size_t(spoke.face)];
        const auto at = [&](int k) -> const Vec3& {
          return control.positions[std::size_t(
              face.vertex[std::size_t((spoke.corner + k + face.size) % face.size)])];
        };
        own += (at(1) - at(0)).cross(at(-1) - at(0));
      }
      const Vec3 normal = (own.normalized() + Vec3(0.2, 0.1, -0.2)).normalized();
      for (std::size_t a = 0; a < 3; ++a) options.normals[3 * vertex + a] = normal[Eigen::Index(a)];
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
      ASSERT_NE(system.couples(), nullptr);
      EXPECT_TRUE(report.levels.back().converged);
      EXPECT_EQ(report.normals.fixed, 1u);
      EXPECT_LT(report.normals.largest_angle, 0.01);
      EXPECT_LT(system.couples()->angle(0, x.data()), 1e-4);

      const GridLevel& grid = run.finest();
      const Unknowns& rows = system.pads() ? system.pads()->rows() : shared.unknowns;
      std::vector<double> forces(3 * grid.size()), held(3 * grid.size(), 0.0);
      apply_thin_plate(grid, shared.double_rows, rows, {}, *problem->workers, shared.double_slots,
                       x.data(), forces.data());
      if (system.hats()) system.hats()->add_loads(surface.state.loads, held.data());
      system.couples()->add(surface.state.moments, held.data());
      double largest = 0, left = 0;
      for (std::size_t i = 0; i < held.size(); ++i) {
        largest = std::max(largest, std::abs(held[i]));
        left = std::max(left, std::abs(forces[i] - held[i]));
      }
      EXPECT_GT(largest, 0);
      EXPECT_LT(left, 1e-3 * largest);
    }
}

}  // namespace
}  // namespace fairing::test
