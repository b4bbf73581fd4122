// SPDX-License-Identifier: GPL-3.0-or-later
// The Gauss-Newton systems: passes against matrices, forces against differences of the energy, and
// spheres.
#include <gtest/gtest.h>

#include <cmath>

#include "curvature/level.h"
#include "grid/linear.h"
#include "meshes.h"
#include "random.h"
#include "transfer/point_normal.h"

namespace fairing::test {
namespace {

constexpr CurvatureEnergy both[] = {CurvatureEnergy::total_curvature,
                                    CurvatureEnergy::minimum_variation};

Unknowns all_but_control_vertices(const ControlMesh& mesh) {
  Unknowns u;
  u.vertex.assign(std::size_t(mesh.vertex_count()), 0);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) u.edge.push_back(!mesh.feature_edge[e]);
  return u;
}

// The refined polyhedron blown up, and shaken a little: no symmetry is left.
Array<double> lumpy(const GridLevel& lattice, double noise) {
  Array<double> x(3 * lattice.size());
  refine_linearly(lattice, lattice.mesh().positions, x.data());
  std::mt19937 random(7);
  UniformReal<> shake(-noise, noise);
  for (std::size_t i = 0; i < x.size(); i += 3) {
    Eigen::Map<Vec3> p(x.data() + i);
    p *= (1 + 0.2 * p.x()) / std::sqrt(0.3 + p.squaredNorm());
    const double z_by = shake(random), y_by = shake(random), x_by = shake(random);
    p += Vec3(x_by, y_by, z_by);
  }
  return x;
}

Array<double> random_displacement(const GridLevel& lattice, const Array<float>& diagonal,
                                  unsigned seed) {
  std::mt19937 random(seed);
  Normal<> normal;
  Array<double> h(lattice.size());
  for (std::size_t i = 0; i < h.size(); ++i) h[i] = diagonal[i] > 0 ? normal(random) : 0.0;
  return h;
}

struct System {
  ControlMesh mesh;
  GridLevel lattice;
  Workers workers{2};
  CurvatureShared shared;
  CurvatureLevel level;
  Functional functional;

  System(const OwnedPolygonMesh& control, int l, CurvatureEnergy energy)
      : mesh(make_control_mesh(control.view(), {})),
        lattice(mesh, l),
        shared{mesh, all_but_control_vertices(mesh), workers},
        level(shared, lattice),
        functional{energy} {}

  // With a share of total curvature, unless `pure`.
  double linearize(const Array<double>& x, Linearization* out = nullptr, bool pure = false) {
    const double value = level.linearize(x.data(), functional, out);
    if (functional.energy == CurvatureEnergy::minimum_variation && !pure)
      level.set_damping({}, 0.01);
    return value;
  }
};

std::vector<std::pair<std::string, OwnedPolygonMesh>> meshes_of_all_kinds() {
  return {{"octahedron", octahedron()}, {"cube", cube()}, {"dodecahedron", dodecahedron()}};
}

TEST(CurvatureLevel, PassesAgreeWithTheMatrix) {
  for (const CurvatureEnergy energy : both)
    for (const auto& [name, control] : meshes_of_all_kinds())
      for (int l = 1; l <= 3; ++l) {
        SCOPED_TRACE(name + ", level " + std::to_string(l));
        System s(control, l, energy);
        s.linearize(lumpy(s.lattice, 0.01));
        const AssembledSystem assembled = s.level.assemble();
        const Array<double> h = random_displacement(s.lattice, s.level.diagonal(), 3);
        Array<double> image(h.size());
        s.level.apply(h.data(), image.data());
        Eigen::VectorXd x(Eigen::Index(assembled.unknown_points.size()));
        for (Eigen::Index i = 0; i < x.size(); ++i)
          x(i) = h[std::size_t(assembled.unknown_points[std::size_t(i)])];
        const Eigen::VectorXd expected = assembled.matrix * x;
        double worst = 0;
        for (Eigen::Index i = 0; i < x.size(); ++i)
          worst = std::max(
              worst,
              std::abs(image[std::size_t(assembled.unknown_points[std::size_t(i)])] - expected(i)));
        EXPECT_LT(worst, 1e-6 * expected.lpNorm<Eigen::Infinity>());
      }
}

// On a smooth surface, to the order of the discretization.
TEST(CurvatureLevel, ForceIsTheEnergysSlope) {
  for (const CurvatureEnergy energy : both) {
    System s(octahedron(), 5, energy);
    Array<double> x(3 * s.lattice.size());
    refine_linearly(s.lattice, s.mesh.positions, x.data());
    for (std::size_t i = 0; i < x.size(); i += 3) {
      Eigen::Map<Vec3> p(x.data() + i);
      p.normalize();
      p = Vec3(p.x(), 1.2 * p.y(), 1.5 * p.z());
    }
    Linearization surface;
    s.linearize(x, &surface, true);
    const auto bump = [&](std::size_t p) {
      const Eigen::Map<const Vec3> at(x.data() + 3 * p);
      return std::exp(-4 * (at - Vec3(0.6, 0.7, 0.9)).squaredNorm());
    };
    const auto energy_at = [&](double t) {
      Array<double> moved = x;
      for (std::size_t i = 0; i < x.size(); ++i) moved[i] += t * bump(i / 3) * surface.normal[i];
      return s.linearize(moved, nullptr, true);
    };
    double slope = 0;
    for (std::size_t p = 0; p < s.lattice.size(); ++p) slope -= 2 * surface.force[p] * bump(p);
    const double t = 1e-4, measured = (energy_at(t) - energy_at(-t)) / (2 * t);
    EXPECT_NEAR(slope, measured, 0.02 * std::abs(measured));
  }
}

TEST(CurvatureLevel, SpheresAreCritical) {
  for (const CurvatureEnergy energy : both)
    for (const auto& [name, control] : meshes_of_all_kinds()) {
      SCOPED_TRACE(name);
      System s(control, 3, energy);
      Array<double> x(3 * s.lattice.size());
      refine_linearly(s.lattice, s.mesh.positions, x.data());
      for (std::size_t i = 0; i < x.size(); i += 3) Eigen::Map<Vec3>(x.data() + i).normalize();
      Linearization surface;
      s.linearize(x, &surface);
      for (std::size_t p = 0; p < s.lattice.size(); ++p)
        EXPECT_NEAR(surface.force[p], 0, 1e-8 * std::sqrt(double(s.level.diagonal()[p]) + 1)) << p;
    }
}

}  // namespace
}  // namespace fairing::test
