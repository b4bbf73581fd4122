// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/control_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>

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

TEST(Chains, CreasesByAngle) {
  EXPECT_EQ(build(roof(), {.crease_angle = 1.5}).chains.size(), 3u);
  EXPECT_EQ(build(roof(), {.crease_angle = 1.6}).chains.size(), 1u);
  EXPECT_EQ(build(cube(), {.crease_angle = 1.0}).chains.size(), 12u);
  EXPECT_EQ(build(dodecahedron(), {.crease_angle = 1.0}).chains.size(),
            30u);  // nothing inside the pentagons
}

}  // namespace
}  // namespace fairing::test
