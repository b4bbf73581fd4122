// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/split.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "mesh/control_mesh.h"
#include "mesh/validate/check.h"
#include "meshes.h"
#include "random.h"

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

// Any simple polygon: a random radius at each angle, then sheared out of its star shape.
OwnedPolygonMesh random_polygon(std::mt19937& random, int corners) {
  UniformReal<> radius(0.2, 1.0);
  std::vector<Point> points;
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * 3.14159265358979 * i / corners, r = radius(random);
    const double x = r * std::cos(angle), y = r * std::sin(angle);
    points.push_back({x + 2 * y * y, y, 0.1 * x * y});
    polygon.push_back(i);
  }
  return make_mesh(points, {polygon});
}

// Each face by the places of its vertices, to the bit, from its least one on.
std::multiset<std::vector<std::array<double, 3>>> faces_in_space(const OwnedPolygonMesh& input,
                                                                 const SplitMesh& mesh,
                                                                 double sign = 1) {
  const auto vertices = Index(input.coordinates.size() / 3);
  std::multiset<std::vector<std::array<double, 3>>> faces;
  for (const SplitFace& face : mesh.faces) {
    std::vector<std::array<double, 3>> corners;
    for (const Index v : face.vertex) {
      if (v < 0) continue;
      const double* p = v < vertices ? &input.coordinates[3 * std::size_t(v)]
                                     : mesh.centres[std::size_t(v - vertices)].data();
      corners.push_back({sign * p[0], sign * p[1], sign * p[2]});
    }
    if (sign < 0) std::reverse(corners.begin(), corners.end());
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    faces.insert(corners);
  }
  return faces;
}

TEST(Split, HasTheSameBitsHoweverItIsNumbered) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 4 + trial % 9;
    OwnedPolygonMesh mesh = random_polygon(random, n);
    if (trial % 3 == 0)  // a regular one, turned: ties all around
      for (int i = 0; i < n; ++i) {
        const double angle = 2 * 3.14159265358979 * i / n + trial;
        mesh.coordinates[3 * std::size_t(i)] = std::cos(angle) + 7;
        mesh.coordinates[3 * std::size_t(i) + 1] = std::sin(angle) - 0.3;
        mesh.coordinates[3 * std::size_t(i) + 2] = 0.1 * trial;
      }
    const auto expected = faces_in_space(mesh, split_polygons(mesh.view()));
    for (int first = 1; first < n; ++first) {
      // Another first corner, and other numbers of the vertices.
      std::vector<std::int64_t> place(static_cast<std::size_t>(n));
      std::iota(place.begin(), place.end(), 0);
      std::shuffle(place.begin(), place.end(), random);
      OwnedPolygonMesh other = mesh;
      for (std::size_t i = 0; i < place.size(); ++i) {
        other.corners[i] =
            place[std::size_t(mesh.corners[(i + std::size_t(first)) % place.size()])];
        std::copy_n(mesh.coordinates.begin() + std::ptrdiff_t(3 * i), 3,
                    other.coordinates.begin() + 3 * place[i]);
      }
      EXPECT_EQ(faces_in_space(other, split_polygons(other.view())), expected) << trial;
    }
    // Turned inside out through the origin.
    OwnedPolygonMesh mirrored = mesh;
    std::reverse(mirrored.corners.begin(), mirrored.corners.end());
    for (double& x : mirrored.coordinates) x = -x;
    EXPECT_EQ(faces_in_space(mirrored, split_polygons(mirrored.view()), -1), expected) << trial;
  }
}

}  // namespace
}  // namespace fairing::test
