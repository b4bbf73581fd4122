// SPDX-License-Identifier: GPL-3.0-or-later
// Folds: found where they are and only there; refilled flat.
#include <gtest/gtest.h>

#include "curvature/fold_repair.h"
#include "curvature/folds.h"
#include "curvature/local_damping.h"
#include "grid/linear.h"
#include "meshes.h"
#include "random.h"

namespace fairing::test {
namespace {

constexpr int level = 3;

struct Sheet {
  ControlMesh mesh;
  GridLevel lattice;
  Workers workers{2};
  Array<double> x;

  explicit Sheet(const OwnedPolygonMesh& control)
      : mesh(make_control_mesh(control.view(), {})), lattice(mesh, level), x(3 * lattice.size()) {
    refine_linearly(lattice, mesh.positions, x.data());
  }
  std::size_t folds(const std::vector<std::uint8_t>& excused = {}) {
    return find_folds(lattice, workers, x.data(), excused).count();
  }
};

std::vector<OwnedPolygonMesh> flat_sheets() { return {triangulated(grid(3, 3)), grid(3, 3)}; }

Index middle_of_face(const Sheet& s, Index f) { return s.lattice.face_point(f, 2, 3); }

Index middle_of_an_inner_edge(const Sheet& s) {
  for (Index e = 0; e < Index(s.mesh.edges.size()); ++e)
    if (!s.mesh.edges[std::size_t(e)].boundary()) return s.lattice.edge_point(e, 3);
  return -1;
}

TEST(Folds, AreFoundInFacesAndOnEdges) {
  for (const OwnedPolygonMesh& control : flat_sheets()) {
    Sheet s(control);
    EXPECT_EQ(s.folds(), 0);
    for (const Index p : {middle_of_face(s, 4), middle_of_an_inner_edge(s)}) {
      const Array<double> flat = s.x;
      s.x[3 * std::size_t(p)] += 0.2;  // neighbours are an eighth away
      EXPECT_GT(s.folds(), 0) << p;
      EXPECT_EQ(s.folds(std::vector<std::uint8_t>(s.mesh.faces.size(), 1)), 0);
      Array<float> marks;
      mark_folds(s.lattice, s.x.data(), find_folds(s.lattice, s.workers, s.x.data(), {}), marks);
      std::size_t marked = 0, far = 0;
      for (std::size_t i = 0; i < marks.size(); ++i) {
        marked += marks[i] > 0;
        const Eigen::Map<const Vec3> from(flat.data() + 3 * std::size_t(p)),
            to(flat.data() + 3 * i);
        far += marks[i] > 0 && (from - to).norm() > 0.4;
      }
      EXPECT_GE(marked, 2);
      EXPECT_EQ(far, 0);
      s.x = flat;
    }
  }
}

TEST(Folds, OfTheControlMeshAreExcused) {
  OwnedPolygonMesh sharp = two_triangles();
  Workers workers(1);
  const ControlMesh flat = make_control_mesh(sharp.view(), {});
  EXPECT_EQ(folded_control_faces(flat, flat.positions, workers), (std::vector<std::uint8_t>{0, 0}));
  std::vector<Vec3> control = flat.positions;
  control[3] = control[1] + Vec3(0, 0, 0.1);  // one triangle lies on the other
  EXPECT_EQ(folded_control_faces(flat, control, workers), (std::vector<std::uint8_t>{1, 1}));
}

TEST(HarmonicFill, IsFlatWhereTheControlMeshIs) {
  for (const OwnedPolygonMesh& control : flat_sheets()) {
    Sheet s(control);
    Unknowns unknowns;
    unknowns.vertex.assign(std::size_t(s.mesh.vertex_count()), 0);
    for (std::size_t e = 0; e < s.mesh.edges.size(); ++e)
      unknowns.edge.push_back(!s.mesh.feature_edge[e]);
    Array<float> marks(s.lattice.size(), 0.0f);
    marks[std::size_t(middle_of_face(s, 4))] = marks[std::size_t(middle_of_an_inner_edge(s))] = 1;
    ElementSlots<float, 1> exchange;
    for (int ring = 0; ring < 3; ++ring) dilate(s.lattice, s.workers, exchange, nullptr, marks);
    const Array<double> flat = s.x;
    std::mt19937 random(5);
    UniformReal<> shake(-1, 1);
    Array<double> filled = s.x;
    std::size_t moved = 0;
    for (std::size_t e = 0; e < s.mesh.edges.size(); ++e)
      for (int k = 1; unknowns.edge[e] && k < s.lattice.n(); ++k) {
        const std::size_t p = std::size_t(s.lattice.edge_point(Index(e), k));
        if (!(marks[p] > 0)) continue;
        for (std::size_t a = 0; a < 3; ++a) filled[3 * p + a] += shake(random);
        ++moved;
      }
    ASSERT_GT(moved, 0);
    fill_harmonically(s.lattice, unknowns, marks, flat.data(), filled.data());
    for (std::size_t i = 0; i < flat.size(); ++i) EXPECT_NEAR(filled[i], flat[i], 1e-12) << i;
  }
}

// A control mesh may have two corners at one place: then grid points coincide too.
TEST(HarmonicFill, GoesWhereANeighbourLiesAtThePoint) {
  Sheet s(grid(3, 3));
  Unknowns unknowns;
  unknowns.vertex.assign(std::size_t(s.mesh.vertex_count()), 0);
  unknowns.edge.assign(s.mesh.edges.size(), 0);
  const Index p = middle_of_face(s, 4);
  Array<float> marks(s.lattice.size(), 0.0f);
  marks[std::size_t(p)] = 1;
  Array<double> shape = s.x, filled = s.x;
  const Index q = s.lattice.face_point(4, 3, 3);  // a neighbour
  std::copy_n(&shape[3 * std::size_t(p)], 3, &shape[3 * std::size_t(q)]);
  fill_harmonically(s.lattice, unknowns, marks, shape.data(), filled.data());
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_DOUBLE_EQ(filled[3 * std::size_t(p) + a], s.x[3 * std::size_t(q) + a]);
}

}  // namespace
}  // namespace fairing::test
