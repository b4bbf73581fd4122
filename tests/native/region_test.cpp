// SPDX-License-Identifier: GPL-3.0-or-later
// Regions: where things are, and the passes against the matrix, with the factors of joints, soft creases
// and flat faces.
#include "mesh/region.h"

#include <gtest/gtest.h>

#include "meshes.h"
#include "random.h"
#include "stencil/weights.h"
#include "thin_plate/differences.h"
#include "thin_plate/operator.h"

namespace fairing::test {
namespace {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

ControlMesh control(const OwnedPolygonMesh& mesh, std::vector<std::int64_t> faces,
                    RegionContinuity joint) {
  FeatureOptions features;
  features.region = {true, std::move(faces), joint};
  return make_control_mesh(mesh.view(), features);
}

Unknowns inside(const ControlMesh& mesh) {
  Unknowns u;
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    u.vertex.push_back(mesh.vertex_part(v) == RegionPart::inside &&
                       !mesh.feature_vertex[std::size_t(v)]);
  for (Index e = 0; e < Index(mesh.edges.size()); ++e)
    u.edge.push_back(mesh.edge_part(e) == RegionPart::inside && !mesh.feature_edge[std::size_t(e)]);
  for (const RegionPart place : mesh.region.face) u.face.push_back(place == RegionPart::inside);
  u.any_vertex = true;
  return u;
}

// Columns and rows of a grid and some of its cells, whole and cut in two.
std::vector<ControlMesh> samples(RegionContinuity joint) {
  return {control(grid(5, 4), {6, 7, 8, 11, 12}, joint), control(grid(3, 3), {4}, joint),
          control(triangulated(grid(5, 4)), {12, 13, 14, 15, 16, 17, 22}, joint),
          control(dodecahedron(), {0, 1, 4}, joint),
          control(torus(6, 5), {0, 1, 2, 5, 6, 7}, joint)};
}

// Lines that end, fork and go on as a crease; flat faces beside them.
std::vector<ControlMesh> with_stiffness() {
  const auto soft = [](const OwnedPolygonMesh& mesh) {
    FeatureOptions features;
    features.soft_creases = {{{6, 7}, {7, 8}, {8, 14}, {8, 9}}, {0.5, 0.8, 0.3, 1.0}};
    features.flat_faces = {0, 1, 5, 6};
    return make_control_mesh(mesh.view(), features);
  };
  return {soft(grid(5, 4)), soft(triangulated(grid(5, 4)))};
}

std::vector<ControlMesh> all_samples() {
  std::vector<ControlMesh> all = with_stiffness();
  for (const RegionContinuity joint :
       {RegionContinuity::position, RegionContinuity::tangent, RegionContinuity::curvature})
    for (ControlMesh& mesh : samples(joint)) all.push_back(std::move(mesh));
  return all;
}

// One edge has one factor at a point, whichever of its faces is asked.
TEST(Region, FactorsAreContinuousAcrossEdges) {
  for (ControlMesh& mesh : all_samples()) {
    mesh.flat = {};  // their factor jumps
    const GridLevel lattice(mesh, 4);
    const EnergyWeight joint(lattice);
    const int n = lattice.n();
    for (const Side& side : mesh.sides) {
      if (mesh.edge_part(side.edge) != RegionPart::inside ||
          mesh.face_part(side.face) != RegionPart::inside)
        continue;
      const bool quad = mesh.faces[std::size_t(side.face)].quad();
      for (int k = 1; k < n; ++k) {
        const GridPoint p = closed_point(quad, n, side.local, k, 0);
        const double on_edge = joint.edge_point(side.edge, side.reversed ? n - k : k);
        EXPECT_NEAR(joint.face_point(side.face, p.i, p.j) / on_edge, 1, 1e-12)
            << "edge " << side.edge << " of face " << side.face << ", point " << k;
      }
    }
  }
}

TEST(Region, PassesAreTheMatrix) {
  Workers workers(2);
  for (const ControlMesh& mesh : all_samples()) {
    const Stencils stencils = make_stencils(mesh, ChartMaker(mesh), workers);
    for (int level = 0; level <= 4; ++level) {
      SCOPED_TRACE(level);
      const GridLevel lattice(mesh, level);
      const Unknowns unknowns = inside(mesh);
      const AssembledSystem system = assemble_thin_plate(lattice, stencils, unknowns, {}, workers);
      const auto count = Eigen::Index(system.unknown_points.size());
      std::mt19937 random(7);
      UniformReal<> number(-1, 1);
      Points x = Points::Zero(Eigen::Index(lattice.size()), 3), small(count, 3);
      for (Eigen::Index i = 0; i < count; ++i)
        for (int a = 0; a < 3; ++a)
          x(system.unknown_points[std::size_t(i)], a) = small(i, a) = number(random);
      const Points image = system.matrix * small;

      const auto check = [&]<class T>(T, double tolerance) {
        const ThinPlateRows<T> rows(mesh, stencils);
        ElementSlots<T> exchange;
        const Eigen::Matrix<T, Eigen::Dynamic, 3, Eigen::RowMajor> in = x.cast<T>();
        Eigen::Matrix<T, Eigen::Dynamic, 3, Eigen::RowMajor> out = in;
        out.setConstant(T(1e9));
        apply_thin_plate(lattice, rows, unknowns, {}, workers, exchange, in.data(), out.data());
        Points expected = Points::Zero(x.rows(), 3);
        for (Eigen::Index i = 0; i < count; ++i)
          expected.row(system.unknown_points[std::size_t(i)]) = image.row(i);
        const Points away = out.template cast<double>() - expected;
        EXPECT_LE(away.cwiseAbs().maxCoeff(), tolerance * (1 + expected.cwiseAbs().maxCoeff()));
        for (std::size_t p = 0, next = 0; p < lattice.size(); ++p) {
          if (next < system.unknown_points.size() && system.unknown_points[next] == Index(p))
            ++next;
          else
            EXPECT_EQ(out.row(Eigen::Index(p)).squaredNorm(), T(0));
        }
      };
      check(1.0, 1e-12);
      check(1.0f, 1e-5);

      ElementSlots<double> exchange;
      const Array<float> diagonal =
          thin_plate_diagonal(lattice, stencils, unknowns, workers, exchange);
      for (Eigen::Index i = 0; i < count; ++i)
        EXPECT_NEAR(diagonal[std::size_t(system.unknown_points[std::size_t(i)])] /
                        system.matrix.coeff(i, i),
                    1, 1e-6);
      const double energy = thin_plate_energy(lattice, stencils, workers, x.data());
      EXPECT_NEAR(energy, (small.cwiseProduct(image)).sum(), 1e-11 * (1 + energy));
    }
  }
}

}  // namespace
}  // namespace fairing::test
