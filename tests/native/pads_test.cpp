// SPDX-License-Identifier: GPL-3.0-or-later
// Pads: their hats and mass matrix, and what is left of the forces on a surface that stands on
// them.
#include "constraints/pads.h"
#include "constraints/diverged.h"

#include <gtest/gtest.h>

#include "constraints/multipliers.h"
#include "curvature/total_curvature.h"
#include "fairing/systems.h"
#include "grid/linear.h"
#include "meshes.h"
#include "parallel/reductions.h"

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

TEST(Pads, MassIsThatOfTheHats) {
  for (const OwnedPolygonMesh& input : {octahedron(), cube(), torus(6, 5), grid(5, 4)})
    for (const double size : {0.5, 1.0}) {
      const ControlMesh mesh = make_control_mesh(input.view(), {});
      Workers workers(2);
      const GridLevel grid(mesh, 2);
      Pads pads(mesh, ChartMaker(mesh), all_but_vertices(mesh), size, workers);
      const Hats hats(pads, grid);
      const auto count = std::size_t(mesh.vertex_count());
      std::vector<std::vector<double>> column;
      for (std::size_t v = 0; v < count; ++v) {
        Loads one(count, Vec3::Zero());
        one[v] = Vec3::Ones();
        column.push_back(loaded(hats, pads.under(v) ? one : Loads(count, Vec3::Zero())));
      }
      // The points' areas from pads of size 1 on all vertices do not exist on open meshes: take
      // them from where a hat is known, as the closed face's share.
      const std::vector<FlatFace> flat = flatten(mesh, centripetal);
      std::vector<double> area(grid.size(), 0.0);
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const bool quad = mesh.faces[f].quad();
        for (int j = 0; j <= 4; ++j)
          for (int i = 0; i <= (quad ? 4 : 4 - j); ++i) {
            const int sides = (i == 0) + (j == 0) + (quad ? (i == 4) + (j == 4) : (i + j == 4));
            const double share = quad ? (sides == 0   ? 1.0
                                         : sides == 1 ? 0.5
                                                      : 0.25)
                                      : (sides == 0   ? 2.0
                                         : sides == 1 ? 1.0
                                                      : 1.0 / 3);
            area[std::size_t(grid.face_point(Index(f), i, j))] += share * flat[f].area / 16;
          }
      }
      Loads unit(count, Vec3::Zero()), product, back;
      for (std::size_t c = 0; c < count; ++c) {
        if (!pads.under(c)) continue;
        unit[c] = Vec3(1, 0, 2);
        hats.multiply_mass<3>(unit, product);
        for (std::size_t d = 0; d < count; ++d) {
          double mass = 0;
          for (std::size_t i = 0; i < grid.size(); ++i)
            mass += column[c][3 * i] * column[d][3 * i] / area[i];
          EXPECT_NEAR(product[d][0], mass, 1e-14);
          EXPECT_NEAR(product[d][2], 2 * mass, 1e-14);
        }
        hats.divide_by_mass<3>(product, back);
        for (std::size_t d = 0; d < count; ++d) EXPECT_LT((back[d] - unit[d]).norm(), 1e-2);
        unit[c].setZero();
      }
    }
}

TEST(Pads, SpringsTakeLoadsByThemselves) {
  const ControlMesh mesh = make_control_mesh(torus(6, 5).view(), {});
  Workers workers(1);
  Pads pads(mesh, ChartMaker(mesh), all_but_vertices(mesh), 1.0, workers);
  const GridLevel grid(mesh, 2);
  const Hats hats(pads, grid);
  const auto count = std::size_t(mesh.vertex_count());
  Loads forces(count), loads, product;
  for (std::size_t v = 0; v < count; ++v) forces[v] = Vec3(std::sin(double(v)), 1, double(v % 3));
  std::vector<double> give(count);
  for (std::size_t v = 0; v < count; ++v) give[v] = v % 2 ? 3.0 : 0.5;
  hats.divide_by_mass<3>(forces, loads, give);
  hats.multiply_mass<3>(loads, product);
  for (std::size_t v = 0; v < count; ++v)
    EXPECT_LT((product[v] + give[v] * hats.total(v) * loads[v] - (1 + give[v]) * forces[v]).norm(),
              1e-2 * forces[v].norm());
  // A spring that gives way altogether: the load is the force, whatever the neighbours have.
  std::fill(give.begin(), give.end(), 1e6);
  hats.divide_by_mass<3>(forces, loads, give);
  for (std::size_t v = 0; v < count; ++v)
    EXPECT_LT((hats.total(v) * loads[v] - forces[v]).norm(), 1e-3 * forces[v].norm());
}

TEST(Pads, StepsSolveWhatPlainCorrectionsDoNot) {
  // f <- f + (b - A f) diverges where A has eigenvalues beyond two; mixed, it is GMRES.
  const std::vector<double> a = {0.1, 0.7, 1.3, 2.6, 4.0}, b = {1, -2, 3, 0.5, 1};
  MultiplierSteps<3> steps = multiplier_steps<3>(nullptr, std::vector<double>(a.size(), 1.0));
  std::vector<double> f(a.size(), 0.0);
  double left = 0;
  for (int round = 0; round < 8; ++round) {
    Multipliers<3> correction;
    left = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      correction.bounds.push_back(b[i] - a[i] * f[i]);
      left += correction.bounds[i] * correction.bounds[i];
    }
    Multipliers<3> change = steps.change(correction);
    for (std::size_t i = 0; i < a.size(); ++i) f[i] += change.bounds[i];
    steps.took(std::move(change));
  }
  EXPECT_LT(std::sqrt(left), 1e-6);
}

TEST(Pads, GoAlone) {
  const ControlMesh mesh = make_control_mesh(torus(6, 5).view(), {});
  Workers workers(1);
  const GridLevel grid(mesh, 3);
  Pads pads(mesh, ChartMaker(mesh), all_but_vertices(mesh), 1.0, workers), whole = pads;
  pads.deactivate(4);
  EXPECT_TRUE(pads.under(3));
  EXPECT_FALSE(pads.under(4));
  EXPECT_TRUE(pads.began_under(4));
  EXPECT_EQ(pads.rows().vertex[3], 1);
  EXPECT_EQ(pads.rows().vertex[4], 0);
  const Hats hats(pads, grid);
  EXPECT_EQ(hats.total(3), Hats(whole, grid).total(3));
  EXPECT_EQ(hats.total(4), 0);
  for (const Index v : {3, 4}) {
    Loads one(std::size_t(mesh.vertex_count()), Vec3::Zero());
    one[std::size_t(v)] = Vec3::Ones();
    const std::vector<double> r = loaded(hats, one);
    double total = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) total += r[3 * i];
    EXPECT_NEAR(total, hats.total(std::size_t(v)), 1e-14);
  }
  for (std::size_t v = 0; v < pads.places().size(); ++v) pads.deactivate(v);
  EXPECT_FALSE(pads.any());
  EXPECT_FALSE(pads.rows().any_vertex);
}

TEST(Pads, ThrownStarsAreFound) {
  const ControlMesh mesh = make_control_mesh(torus(8, 6).view(), {});
  Workers workers(2);
  const GridLevel grid(mesh, 2);
  std::vector<double> x(3 * grid.size());
  refine_linearly(grid, mesh.positions, workers, x.data());
  EXPECT_TRUE(diverged_stars(grid, workers, mesh.positions, x.data()).empty());
  const auto at = 3 * std::size_t(grid.face_base(5));
  for (const double far : {100.0, std::numeric_limits<double>::quiet_NaN()}) {
    x[at] = far;
    std::vector<Index> corners(mesh.faces[5].vertex.begin(), mesh.faces[5].vertex.end());
    std::sort(corners.begin(), corners.end());
    EXPECT_EQ(diverged_stars(grid, workers, mesh.positions, x.data()), corners);
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
