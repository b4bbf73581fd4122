// SPDX-License-Identifier: GPL-3.0-or-later
// The Gauss-Newton systems: forces against differences of the energy, and spheres.
#include <gtest/gtest.h>

#include <cmath>

#include "curvature/level.h"
#include "meshes.h"
#include "polyhedron.h"

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
