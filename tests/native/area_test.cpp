// SPDX-License-Identifier: GPL-3.0-or-later
// Tension beside a curvature energy: areas, forces, and the Laplacian in all its forms.
#include <gtest/gtest.h>

#include <cmath>

#include "curvature/area.h"
#include "curvature/level.h"
#include "level_settings.h"
#include "parallel/reductions.h"
#include "polyhedron.h"

namespace fairing::test {
namespace {

constexpr double tau = 3;

// The sum over cells, a quad's over both of its diagonals.
double area_of_cells(const GridLevel& grid, const Array<double>& x) {
  const auto at = [&](Index p) {
    return Vec3(x[3 * std::size_t(p)], x[3 * std::size_t(p) + 1], x[3 * std::size_t(p) + 2]);
  };
  const auto triangle = [&](Index a, Index b, Index c) {
    return 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).norm();
  };
  double sum = 0;
  for (const Cell& c : cells(grid))
    sum += c[3] < 0 ? triangle(c[0], c[1], c[2])
                    : 0.5 * (triangle(c[0], c[1], c[2]) + triangle(c[0], c[2], c[3]) +
                             triangle(c[0], c[1], c[3]) + triangle(c[1], c[2], c[3]));
  return sum;
}

// The refined polyhedron, shaken, with directions at its points that are nobody's normals.
struct Lumpy {
  Array<double> x, normal;
  explicit Lumpy(const GridLevel& grid) : x(3 * grid.size()), normal(3 * grid.size()) {
    refine_linearly(grid, grid.mesh().positions, x.data());
    const Points shake = random_points(grid.size(), 4), directions = random_points(grid.size(), 5);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] += 0.2 / grid.n() * shake.data()[i];
      normal[i] = directions.data()[i];
    }
  }
};

void on_grids(int most_levels, const std::function<void(const GridLevel&)>& body) {
  for (const auto& [name, mesh] : all_meshes())
    for (int level = 0; level <= most_levels; ++level) {
      SCOPED_TRACE(name + ", level " + std::to_string(level));
      body(GridLevel(mesh, level));
    }
}

TEST(Area, IsThatOfTheCells) {
  Workers workers(2);
  on_grids(3, [&](const GridLevel& grid) {
    const Lumpy surface(grid);
    const double expected = area_of_cells(grid, surface.x);
    EXPECT_NEAR(surface_area(grid, workers, surface.x.data()), expected, 1e-12 * expected);
    AreaTerm term(grid);
    EXPECT_EQ(
        term.linearize(tau, surface.x.data(), nullptr, all_points(grid.mesh()), workers, nullptr),
        tau * surface_area(grid, workers, surface.x.data()));
  });
}

// Exact, on any surface and along any directions: points and triangles are the area's own.
TEST(Area, ForceIsHalfItsSlope) {
  Workers workers(2);
  on_grids(2, [&](const GridLevel& grid) {
    const Lumpy surface(grid);
    const std::size_t points = grid.size();
    for (int choice = 0; choice < 2; ++choice) {
      const Unknowns unknowns = some_points(grid.mesh(), choice);
      Array<double> force(points, 1.0);
      AreaTerm(grid).linearize(tau, surface.x.data(), surface.normal.data(), unknowns, workers,
                               force.data());
      const std::vector<std::uint8_t> unknown = unknown_points(grid, unknowns);
      const Points h = random_points(points, 9);
      double slope = 0;
      for (std::size_t p = 0; p < points; ++p) {
        if (unknown[p]) {
          slope -= 2 * (force[p] - 1) * h(Eigen::Index(p), 0);
        } else {
          EXPECT_EQ(force[p], 1);
        }
      }
      const auto energy = [&](double t) {
        Array<double> moved = surface.x;
        for (std::size_t i = 0; i < moved.size(); ++i)
          if (unknown[i / 3]) moved[i] += t * h(Eigen::Index(i / 3), 0) * surface.normal[i];
        return tau * area_of_cells(grid, moved);
      };
      const double t = 1e-5 / grid.n(), measured = (energy(t) - energy(-t)) / (2 * t);
      EXPECT_NEAR(slope, measured, 1e-6 * (std::abs(measured) + tau));
    }
  });
}

// The whole system under tension: passes, and the matrix of small faces, against the assembled one.
TEST(Area, JoinsTheSystemOfEitherEnergy) {
  for (const CurvatureEnergy energy :
       {CurvatureEnergy::total_curvature, CurvatureEnergy::minimum_variation})
    for (const char* name : {"cube", "icosahedron", "dodecahedron", "mixed grid", "grid, free"})
      for (int level = 1; level <= 4; ++level) {
        SCOPED_TRACE(std::string(name) + ", level " + std::to_string(level));
        Workers workers(2);
        const ControlMesh& mesh = all_meshes().at(name);
        const GridLevel grid(mesh, level);
        CurvatureShared shared{mesh, some_points(mesh, 1), workers};
        shared.tension = tau;
        CurvatureLevel system(shared, grid);
        Array<double> x = Lumpy(grid).x;
        Linearization surface;
        const double whole = system.linearize(x.data(), {energy}, &surface);
        if (energy == CurvatureEnergy::minimum_variation) system.set_damping({}, 0.01);
        CurvatureShared free{mesh, some_points(mesh, 1), workers};
        const double bending = CurvatureLevel(free, grid).linearize(x.data(), {energy});
        EXPECT_NEAR(whole - bending, tau * area_of_cells(grid, x), 1e-9 * whole);
        EXPECT_EQ(whole, system.objective());

        const AssembledSystem assembled = system.assemble();
        const std::vector<Index> number = number_unknowns(grid, shared.unknowns);
        const Points h = masked(grid, shared.unknowns, random_points(grid.size()));
        Array<double> in(grid.size()), out(grid.size());
        Array<float> narrow(grid.size() + vector_room), narrow_out(grid.size() + vector_room);
        Eigen::VectorXd small(assembled.matrix.cols());
        for (std::size_t p = 0; p < in.size(); ++p) {
          in[p] = h(Eigen::Index(p), 0), narrow[p] = float(in[p]);
          if (number[p] >= 0) small(number[p]) = in[p];
        }
        system.apply(in.data(), out.data());
        system.apply(narrow.data(), narrow_out.data());
        small = assembled.matrix * small;
        const double scale = small.lpNorm<Eigen::Infinity>();
        for (std::size_t p = 0; p < in.size(); ++p) {
          const double expected = number[p] < 0 ? 0 : small(number[p]);
          EXPECT_NEAR(out[p], expected, 1e-6 * scale) << p;
          if (system.varies()) continue;  // narrow: another matrix, which cycles are of
          EXPECT_NEAR(narrow_out[p], expected, 1e-5 * scale) << p;
          if (number[p] >= 0) {
            EXPECT_NEAR(system.diagonal()[p], assembled.matrix.coeff(number[p], number[p]),
                        1e-5 * double(system.diagonal()[p]));
          }
        }
      }
}

}  // namespace
}  // namespace fairing::test
