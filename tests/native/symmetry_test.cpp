// SPDX-License-Identifier: GPL-3.0-or-later
// Mirror symmetries of control meshes.
#include "mesh/symmetry.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "meshes.h"

namespace fairing::test {
namespace {

constexpr double tolerance = 1e-12;

const auto any = [](const Mirror&) { return true; };

ControlMesh control(const OwnedPolygonMesh& mesh, const FeatureOptions& features = {}) {
  return make_control_mesh(mesh.view(), features);
}

// Centred, at size one, as the driver has it.
ControlMesh working(ControlMesh mesh) {
  Vec3 low = mesh.positions[0], high = low;
  for (const Vec3& p : mesh.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (Vec3& p : mesh.positions) p = (p - 0.5 * (low + high)) / (high - low).maxCoeff();
  return mesh;
}

ControlMesh turned(ControlMesh mesh) {
  const Eigen::AngleAxisd turn(0.7, Vec3(1, -2, 0.5).normalized());
  for (Vec3& p : mesh.positions) p = turn * p;
  return working(std::move(mesh));
}

Symmetry symmetry(const ControlMesh& mesh) { return find_symmetry(mesh, tolerance, any); }

std::vector<Mirror> mirrors(const ControlMesh& mesh) {
  std::vector<Mirror> out;
  for (const auto& mirror : symmetry(mesh).mirrors) out.push_back(*mirror);
  return out;
}

// All elements' images agree with each other.
void expect_a_mirror(const ControlMesh& mesh, const Mirror& mirror) {
  const auto at = [](const auto& values, Index i) { return values[std::size_t(i)]; };
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_EQ(at(mirror.vertex, at(mirror.vertex, v)), v);
    const Vec3 image = mirror.plane.image(at(mesh.positions, v));
    EXPECT_LE((image - at(mesh.positions, at(mirror.vertex, v))).norm(), tolerance);
  }
  for (Index e = 0; e < Index(mesh.edges.size()); ++e) {
    const Edge &edge = at(mesh.edges, e), &image = at(mesh.edges, at(mirror.edge, e));
    const std::size_t first = mirror.reverses(mesh, e) ? 1 : 0;
    EXPECT_EQ(image.vertex[first], at(mirror.vertex, edge.vertex[0]));
    EXPECT_EQ(image.vertex[1 - first], at(mirror.vertex, edge.vertex[1]));
  }
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    const Face &face = at(mesh.faces, f), &image = at(mesh.faces, at(mirror.face, f));
    ASSERT_EQ(face.size, image.size);
    if (at(mirror.turn, f) == Mirror::in_plane) {
      EXPECT_EQ(at(mirror.face, f), f);
      for (int c = 0; c < face.size; ++c)
        EXPECT_EQ(at(mirror.vertex, at(face.vertex, c)), at(face.vertex, c));
      continue;
    }
    for (int c = 0; c < face.size; ++c)
      EXPECT_EQ(image.vertex[std::size_t((at(mirror.turn, f) - c + face.size) % face.size)],
                at(mirror.vertex, face.vertex[std::size_t(c)]));
  }
}

TEST(Mirror, OfSymmetricMeshes) {
  const std::pair<OwnedPolygonMesh, std::size_t> cases[] = {
      {cube(), 3},        {octahedron(), 3},  {icosahedron(), 3},    {dodecahedron(), 3},
      {torus(8, 6), 3},   {tetrahedron(), 2}, {square_pyramid(), 2}, {single_triangle(), 1},
      {single_quad(), 2}, {grid(4, 3), 2},    {open_cone(5), 1},     {u_shape(), 1}};
  for (const auto& [mesh, count] : cases)
    for (const ControlMesh& placed : {working(control(mesh)), turned(control(mesh))}) {
      const std::vector<Mirror> found = mirrors(placed);
      EXPECT_EQ(found.size(), count) << placed.faces.size() << " faces";
      for (const Mirror& mirror : found) expect_a_mirror(placed, mirror);
      for (std::size_t i = 0; i < found.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
          EXPECT_NEAR(found[i].plane.normal.dot(found[k].plane.normal), 0, 1e-12);
    }
}

TEST(Mirror, VerticesAtOnePlaceAreToldApart) {
  // Two quads whose near sides coincide, without being joined.
  const OwnedPolygonMesh slit = make_mesh(
      {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
      {{0, 1, 2, 3}, {4, 5, 6, 7}});
  const ControlMesh mesh = working(control(slit));
  const std::vector<Mirror> found = mirrors(mesh);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].plane.normal, Vec3::UnitX());
  EXPECT_EQ(found[0].vertex, (std::vector<Index>{5, 4, 7, 6, 1, 0, 3, 2}));
}

}  // namespace
}  // namespace fairing::test
