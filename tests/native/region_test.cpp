// SPDX-License-Identifier: GPL-3.0-or-later
// Regions: where things are, and the passes with the joint's factors against the matrix.
#include "control_mesh/region.h"

#include <gtest/gtest.h>

#include <random>

#include "energy/assemble.h"
#include "energy/joint_weight.h"
#include "meshes.h"
#include "thrown.h"

namespace fairing::test {
namespace {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

ControlMesh control(const OwnedPolygonMesh& mesh, std::vector<std::int64_t> faces, Joint joint) {
  FeatureOptions features;
  features.region = {true, std::move(faces), joint};
  return make_control_mesh(mesh.view(), features);
}

Unknowns inside(const ControlMesh& mesh) {
  Unknowns u;
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    u.vertex.push_back(mesh.vertex_place(v) == Place::inside && !mesh.feature_vertex[std::size_t(v)]);
  for (Index e = 0; e < Index(mesh.edges.size()); ++e)
    u.edge.push_back(mesh.edge_place(e) == Place::inside && !mesh.feature_edge[std::size_t(e)]);
  for (const Place place : mesh.region.face) u.face.push_back(place == Place::inside);
  u.any_vertex = true;
  return u;
}

// Columns and rows of a grid and some of its cells, whole and cut in two.
std::vector<ControlMesh> samples(Joint joint) {
  return {control(grid(5, 4), {6, 7, 8, 11, 12}, joint), control(grid(3, 3), {4}, joint),
          control(triangulated(grid(5, 4)), {12, 13, 14, 15, 16, 17, 22}, joint),
          control(dodecahedron(), {0, 1, 4}, joint), control(torus(6, 5), {0, 1, 2, 5, 6, 7}, joint)};
}

TEST(Region, Places) {
  const ControlMesh mesh = control(grid(3, 3), {3, 4}, Joint::curvature);
  EXPECT_EQ(std::count(mesh.region.face.begin(), mesh.region.face.end(), Place::inside), 2);
  EXPECT_EQ(std::count(mesh.region.edge.begin(), mesh.region.edge.end(), Place::joint), 5);
  EXPECT_EQ(std::count(mesh.region.edge.begin(), mesh.region.edge.end(), Place::inside), 2);
  EXPECT_EQ(std::count(mesh.region.vertex.begin(), mesh.region.vertex.end(), Place::joint), 6);
  EXPECT_EQ(std::count(mesh.region.vertex.begin(), mesh.region.vertex.end(), Place::inside), 0);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    EXPECT_EQ(mesh.region.clamped_edge[e] != 0, mesh.region.edge[e] == Place::joint);
  // the one edge on the boundary is a curve of its own, and ends at the joint
  std::size_t curves = 0;
  for (const Chain& chain : mesh.chains) curves += chain.edges.size();
  EXPECT_EQ(curves, 1u);
}

TEST(Region, AllFacesAreNone) {
  EXPECT_TRUE(control(cube(), {5, 4, 3, 2, 1, 0, 0}, Joint::tangent).region.whole());
}

TEST(Region, Refusals) {
  EXPECT_EQ(thrown([] { control(cube(), {}, Joint::tangent); }).code, ErrorCode::bad_option);
  const FairingError error = thrown([] { control(cube(), {6, 2, -1}, Joint::tangent); });
  EXPECT_EQ(error.code, ErrorCode::index_out_of_range);
  EXPECT_EQ(error.elements, (std::vector<std::int64_t>{6, -1}));
}

// One edge has one factor at a point, whichever of its faces is asked.
TEST(Region, FactorsAreContinuousAcrossEdges) {
  for (const ControlMesh& mesh : samples(Joint::curvature)) {
    const Lattice lattice(mesh, 4);
    const JointWeight joint(lattice);
    const int n = lattice.n();
    for (const Side& side : mesh.sides) {
      if (mesh.edge_place(side.edge) != Place::inside || mesh.face_place(side.face) != Place::inside)
        continue;
      const bool quad = mesh.faces[std::size_t(side.face)].quad();
      for (int k = 1; k < n; ++k) {
        const LatticePoint p = closed_point(quad, n, side.local, k, 0);
        EXPECT_DOUBLE_EQ(joint.face_point(side.face, p.i, p.j),
                         joint.edge_point(side.edge, side.reversed ? n - k : k));
      }
    }
  }
}

TEST(Region, PassesAreTheMatrix) {
  Workers workers(2);
  for (const Joint joint : {Joint::position, Joint::tangent, Joint::curvature})
    for (const ControlMesh& mesh : samples(joint)) {
      const Stencils stencils = make_stencils(mesh, {}, workers);
      for (int level = 0; level <= 4; ++level) {
        SCOPED_TRACE(level);
        const Lattice lattice(mesh, level);
        const Unknowns unknowns = inside(mesh);
        const AssembledSystem system = assemble_thin_plate(lattice, stencils, unknowns, {});
        const auto count = Eigen::Index(system.unknown_points.size());
        std::mt19937 random(7);
        std::uniform_real_distribution<double> number(-1, 1);
        Points x = Points::Zero(Eigen::Index(lattice.size()), 3), small(count, 3);
        for (Eigen::Index i = 0; i < count; ++i)
          for (int a = 0; a < 3; ++a)
            x(system.unknown_points[std::size_t(i)], a) = small(i, a) = number(random);
        const Points image = system.matrix * small;

        const auto check = [&]<class T>(T, double tolerance) {
          const ThinPlateRows<T> rows(mesh, stencils);
          Exchange<T> exchange;
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

        const ThinPlateRows<double> rows(mesh, stencils);
        Exchange<double> exchange;
        const Array<float> diagonal = thin_plate_diagonal(lattice, rows, unknowns, {}, workers, exchange);
        for (Eigen::Index i = 0; i < count; ++i)
          EXPECT_NEAR(
              diagonal[std::size_t(system.unknown_points[std::size_t(i)])] / system.matrix.coeff(i, i), 1,
              1e-6);
        const double energy = thin_plate_energy(lattice, rows, workers, x.data());
        EXPECT_NEAR(energy, (small.cwiseProduct(image)).sum(), 1e-11 * (1 + energy));
      }
    }
}

}  // namespace
}  // namespace fairing::test
