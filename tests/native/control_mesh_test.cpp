// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/control_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "control_mesh_invariants.h"
#include "mesh/validate/check.h"
#include "meshes.h"

namespace fairing::test {
namespace {

ControlMesh build(const OwnedPolygonMesh& mesh, const FeatureOptions& features = {}) {
  check(mesh.view());
  ControlMesh control = make_control_mesh(mesh.view(), features);
  expect_consistent(control);
  return control;
}

std::map<std::size_t, int> interior_valences(const ControlMesh& mesh) {
  std::map<std::size_t, int> histogram;
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.interior(v)) ++histogram[mesh.ring(v).size()];
  return histogram;
}

int euler_characteristic(const ControlMesh& mesh) {
  return mesh.vertex_count() - int(mesh.edges.size()) + int(mesh.faces.size());
}

using Valences = std::map<std::size_t, int>;

TEST(ControlMesh, ClosedMeshes) {
  EXPECT_EQ(interior_valences(build(tetrahedron())), (Valences{{3, 4}}));
  EXPECT_EQ(interior_valences(build(cube())), (Valences{{3, 8}}));
  EXPECT_EQ(interior_valences(build(cube_triangles())), (Valences{{4, 4}, {5, 4}}));
  EXPECT_EQ(interior_valences(build(octahedron())), (Valences{{4, 6}}));
  EXPECT_EQ(interior_valences(build(icosahedron())), (Valences{{5, 12}}));
  EXPECT_EQ(interior_valences(build(square_pyramid())), (Valences{{3, 4}, {4, 1}}));
  EXPECT_EQ(interior_valences(build(torus(6, 5))), (Valences{{4, 30}}));
  EXPECT_EQ(euler_characteristic(build(cube())), 2);
  EXPECT_EQ(euler_characteristic(build(torus(6, 5))), 0);
  EXPECT_EQ(euler_characteristic(build(two_tetrahedra())), 4);
  EXPECT_TRUE(build(cube()).chains.empty());
}

TEST(ControlMesh, KeepsFacesAsTheyAre) {
  const ControlMesh mesh = build(cube());
  ASSERT_EQ(mesh.faces.size(), 6u);
  EXPECT_EQ(mesh.faces[0].vertex, (std::array<Index, 4>{0, 3, 2, 1}));
  EXPECT_TRUE(mesh.faces[0].quad());
  EXPECT_EQ(mesh.faces[5].polygon, 5);
  EXPECT_EQ(mesh.input_vertices, 8);
  EXPECT_EQ(mesh.positions[6], Vec3(1, 1, 1));
}

TEST(ControlMesh, OpenRingsStartAtTheFirstBoundaryEdge) {
  const ControlMesh mesh = build(half_fan(4));
  const auto ring = mesh.ring(0);
  ASSERT_EQ(ring.size(), 5u);
  EXPECT_FALSE(mesh.interior(0));
  for (std::size_t i = 0; i < 5; ++i) {
    const Edge& edge = mesh.edges[std::size_t(ring[i].edge)];
    EXPECT_EQ(std::max(edge.vertex[0], edge.vertex[1]), Index(i + 1));
    EXPECT_EQ(ring[i].face, i < 4 ? Index(i) : -1);
  }
}

TEST(ControlMesh, ClosedRingsRunCounterClockwise) {
  const ControlMesh mesh = build(fan(360));
  EXPECT_EQ(mesh.ring(0).size(), 360u);
  for (std::size_t i = 0; i + 1 < 360; ++i)
    EXPECT_EQ((mesh.ring(0)[i].face + 1) % 360, mesh.ring(0)[i + 1].face);
}

TEST(ControlMesh, TurnsTheFacesThatTheCheckHasFound) {
  const OwnedPolygonMesh mesh = flipped_cube_face();
  const CheckResult result = check(mesh.view(), {.repair = true});
  const ControlMesh control = make_control_mesh(mesh.view(), {}, result.flipped_faces);
  expect_consistent(control);
  EXPECT_EQ(euler_characteristic(control), 2);
  EXPECT_EQ(interior_valences(control), (Valences{{3, 8}}));
}

TEST(ControlMesh, BoundaryModes) {
  const ControlMesh curve = build(open_cylinder(5));
  ASSERT_EQ(curve.chains.size(), 2u);
  EXPECT_TRUE(curve.chains[0].closed);
  EXPECT_FALSE(curve.chains[0].straight);
  EXPECT_EQ(curve.chains[0].vertices.size(), 5u);

  const ControlMesh linear = build(open_cylinder(5), {.boundary = BoundaryMode::linear});
  EXPECT_TRUE(linear.chains.at(0).straight);

  const ControlMesh free = build(open_cylinder(5), {.boundary = BoundaryMode::free});
  EXPECT_TRUE(free.chains.empty());
  EXPECT_EQ(std::count(free.feature_vertex.begin(), free.feature_vertex.end(), 1), 0);
}

TEST(Chains, EndAtGivenCornersAndSharpTurns) {
  EXPECT_EQ(build(grid(3, 2)).chains.size(), 1u);
  EXPECT_EQ(build(grid(3, 2), {.corner_angle = 1.0}).chains.size(), 4u);

  const ControlMesh one = build(grid(3, 2), {.corner_vertices = {0}});
  ASSERT_EQ(one.chains.size(), 1u);
  EXPECT_FALSE(one.chains[0].closed);
  EXPECT_EQ(one.chains[0].vertices.front(), 0);
  EXPECT_EQ(one.chains[0].vertices.back(), 0);
  EXPECT_EQ(one.chains[0].edges.size(), 10u);
}

TEST(Chains, EndWhereThreeMeetAndInTheOpen) {
  // A crease over the grid's middle: it cuts the boundary loop into two, and is one chain itself.
  const ControlMesh across = build(grid(2, 2), {.crease_edges = {{1, 4}, {7, 4}}});
  EXPECT_EQ(across.chains.size(), 3u);
  // Only half way: a dart.
  const ControlMesh dart = build(grid(2, 2), {.crease_edges = {{4, 1}}});
  EXPECT_EQ(dart.chains.size(), 2u);
  EXPECT_TRUE(dart.feature_vertex[4]);
}

TEST(Chains, MixedBoundaryAndCreaseInLinearMode) {
  const ControlMesh mesh =
      build(grid(2, 2), {.crease_edges = {{1, 4}, {7, 4}}, .boundary = BoundaryMode::linear});
  EXPECT_EQ(std::count_if(mesh.chains.begin(), mesh.chains.end(),
                          [](const Chain& c) { return c.straight; }),
            2);
}

FeatureOptions with_edges(BoundaryMode all, BoundaryMode some,
                          std::vector<std::array<std::int64_t, 2>> edges) {
  FeatureOptions options{.boundary = all};
  options.boundary_edges[std::size_t(some)] = std::move(edges);
  return options;
}

// The border of grid(2, 2) is 0 1 2 5 8 7 6 3.
TEST(Chains, EndWhereTheBoundaryChanges) {
  for (const BoundaryMode all : {BoundaryMode::curve, BoundaryMode::linear}) {
    const BoundaryMode other =
        all == BoundaryMode::curve ? BoundaryMode::linear : BoundaryMode::curve;
    const ControlMesh mesh = build(grid(2, 2), with_edges(all, other, {{2, 1}, {2, 5}}));
    ASSERT_EQ(mesh.chains.size(), 2u);
    for (const Chain& chain : mesh.chains) {
      EXPECT_FALSE(chain.closed);
      EXPECT_EQ(chain.straight, (all == BoundaryMode::linear) == (chain.edges.size() == 6));
      EXPECT_EQ(std::min(chain.vertices.front(), chain.vertices.back()), 1);
      EXPECT_EQ(std::max(chain.vertices.front(), chain.vertices.back()), 5);
    }
  }
}

TEST(Chains, ClosedCrease) {
  const ControlMesh mesh = build(cube(), {.crease_edges = {{4, 5}, {5, 6}, {6, 7}, {7, 4}}});
  ASSERT_EQ(mesh.chains.size(), 1u);
  EXPECT_TRUE(mesh.chains[0].closed);
  EXPECT_EQ(mesh.chains[0].vertices.size(), 4u);
}

TEST(Chains, CreasesByAngle) {
  EXPECT_EQ(build(roof(), {.crease_angle = 1.5}).chains.size(), 3u);
  EXPECT_EQ(build(roof(), {.crease_angle = 1.6}).chains.size(), 1u);
  EXPECT_EQ(build(cube(), {.crease_angle = 1.0}).chains.size(), 12u);
  EXPECT_EQ(build(dodecahedron(), {.crease_angle = 1.0}).chains.size(),
            30u);  // nothing inside the pentagons
}

}  // namespace
}  // namespace fairing::test
