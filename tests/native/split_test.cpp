// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/split.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "mesh/control_mesh.h"
#include "mesh/validate/check.h"
#include "meshes.h"

namespace fairing::test {
namespace {

SplitMesh split(const OwnedPolygonMesh& mesh) {
  check(mesh.view());
  return split_polygons(mesh.view());
}

std::set<std::set<Index>> vertex_sets(const SplitMesh& mesh) {
  std::set<std::set<Index>> sets;
  for (const SplitFace& face : mesh.faces) {
    std::set<Index> set(face.vertex.begin(), face.vertex.end());
    set.erase(-1);
    sets.insert(set);
  }
  return sets;
}

using Sets = std::set<std::set<Index>>;

double area(const OwnedPolygonMesh& input, const SplitMesh& mesh) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < input.coordinates.size(); i += 3)
    points.emplace_back(input.coordinates[i], input.coordinates[i + 1], input.coordinates[i + 2]);
  points.insert(points.end(), mesh.centres.begin(), mesh.centres.end());
  double sum = 0;
  for (const SplitFace& face : mesh.faces) {
    EXPECT_LT(face.vertex[3], 0);
    const Vec3& a = points[std::size_t(face.vertex[0])];
    sum += 0.5 * (points[std::size_t(face.vertex[1])] - a)
                     .cross(points[std::size_t(face.vertex[2])] - a)
                     .z();
    EXPECT_GT((points[std::size_t(face.vertex[1])] - a)
                  .cross(points[std::size_t(face.vertex[2])] - a)
                  .z(),
              0);
  }
  return sum;
}

TEST(Split, FansOfStarShapedPolygons) {
  const SplitMesh pentagons = split(dodecahedron());
  EXPECT_EQ(pentagons.faces.size(), 60u);
  ASSERT_EQ(pentagons.centres.size(), 12u);
  EXPECT_EQ(pentagons.faces[7].polygon, 1);

  const SplitMesh l = split(l_shape());
  ASSERT_EQ(l.centres.size(), 1u);
  EXPECT_NEAR((l.centres[0] - Vec3(5, 5, 0) / 6).norm(), 0, 1e-15);  // the centroid of the area
  EXPECT_NEAR(area(l_shape(), l), 3, 1e-14);
}

TEST(Split, OtherPolygonsAreTriangulatedSymmetrically) {
  // The bar between the legs can be cut by two mirrored diagonals: it gets a centre instead.
  const SplitMesh u = split(u_shape());
  EXPECT_NEAR(area(u_shape(), u), 7, 1e-14);
  ASSERT_EQ(u.centres.size() % 2, 1u);
  const bool on_the_axis = std::any_of(u.centres.begin(), u.centres.end(),
                                       [](const Vec3& c) { return std::abs(c.x() - 1.5) < 1e-14; });
  EXPECT_TRUE(on_the_axis);
  const std::array<Index, 8> mirrored{1, 0, 7, 6, 5, 4, 3, 2};
  Sets without_centres, their_mirror;
  for (const SplitFace& face : u.faces) {
    if (*std::max_element(face.vertex.begin(), face.vertex.end()) > 7) continue;
    without_centres.insert({face.vertex[0], face.vertex[1], face.vertex[2]});
    their_mirror.insert({mirrored[std::size_t(face.vertex[0])],
                         mirrored[std::size_t(face.vertex[1])],
                         mirrored[std::size_t(face.vertex[2])]});
  }
  EXPECT_EQ(without_centres, their_mirror);
}

TEST(Split, ConcaveQuads) {
  EXPECT_EQ(vertex_sets(split(arrow())), (Sets{{0, 1, 3}, {1, 2, 3}}));
  EXPECT_EQ(vertex_sets(split(flat_corner())), (Sets{{0, 1, 3}, {1, 2, 3}}));
}

TEST(Split, WarpedQuads) {
  EXPECT_EQ(split(warped_quad(0.2)).faces.size(), 1u);
  const SplitMesh symmetric = split(warped_quad(0.8));
  EXPECT_EQ(symmetric.faces.size(), 4u);
  ASSERT_EQ(symmetric.centres.size(), 1u);
  EXPECT_NEAR((symmetric.centres[0] - Vec3(0.5, 0.5, 0.4)).norm(), 0, 1e-15);

  OwnedPolygonMesh long_one =
      warped_quad(0.9);  // folded along the long diagonal it would be the flatter… it is not
  long_one.coordinates[6] = long_one.coordinates[7] = 1.1;
  EXPECT_EQ(vertex_sets(split(long_one)), (Sets{{0, 1, 3}, {1, 2, 3}}));
}

TEST(Split, NeverTakesADiagonalThatIsAnEdge) {
  // The arrow's best diagonal 1-3 is an edge already, of a triangle behind it.
  OwnedPolygonMesh mesh = arrow();
  mesh.coordinates.insert(mesh.coordinates.end(), {1, 0, -1});
  mesh.corners.insert(mesh.corners.end(), {1, 3, 4});
  mesh.offsets.push_back(7);
  // Faces that touch in two vertices without an edge are two fans there; only split_polygons sees
  // this mesh.
  const SplitMesh result = split_polygons(mesh.view());
  EXPECT_EQ(vertex_sets(result).count({0, 1, 3}), 0u);
}

TEST(Split, OpensVerticesOfValenceTwo) {
  const SplitMesh both = split(quad_doublet());
  EXPECT_EQ(vertex_sets(both), (Sets{{0, 1, 3}, {1, 2, 3}, {1, 2, 4}, {0, 1, 4}}));

  // A quad and a triangle around vertex 1.
  const auto one =
      make_mesh({{-1, 0, 0}, {0, 0, 0.2}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2, 3}, {2, 1, 0}});
  EXPECT_EQ(vertex_sets(split(one)), (Sets{{0, 1, 3}, {1, 2, 3}, {0, 1, 2}}));

  // A quad that wraps a corner of a pentagon twice: neighbouring vertices of valence two leave no
  // diagonal.
  const auto wrapped = make_mesh({{0, 0, 0}, {1, 0, 0.1}, {1, 1, 0.1}, {0, 1, 0}, {2, 0.5, 0}},
                                 {{0, 1, 2, 3}, {3, 2, 1, 0, 4}});
  make_control_mesh(wrapped.view(), {});
}

}  // namespace
}  // namespace fairing::test
