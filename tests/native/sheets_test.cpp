// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes whose sheets meet: what is cut, what is a copy of what, and the curves in between.
#include "mesh/sheets.h"

#include <gtest/gtest.h>

#include <set>

#include "control_mesh_invariants.h"
#include "fairing/output.h"
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

// Of the chains of non-manifold edges: how many edges each has.
std::multiset<std::size_t> lengths_of_meetings(const ControlMesh& mesh) {
  std::multiset<std::size_t> lengths;
  for (const Chain& chain : mesh.chains)
    if (mesh.nonmanifold(chain.edges[0])) lengths.insert(chain.edges.size());
  return lengths;
}

TEST(Sheets, BothHalvesOfACoverHaveTheSameBoundary) {
  const ControlMesh whole = build(mobius(5));
  const Edge& some = whole.edges[std::size_t(whole.chains.at(0).edges[3])];
  FeatureOptions options;
  options.boundary_edges[std::size_t(BoundaryMode::free)] = {
      {whole.original_vertex(some.vertex[1]), whole.original_vertex(some.vertex[0])}};
  const ControlMesh mesh = build(mobius(5), options);
  ASSERT_EQ(mesh.chains.size(), 1u);
  EXPECT_EQ(mesh.chains[0].edges.size(), 9u);
  EXPECT_EQ(std::count(whole.feature_edge.begin(), whole.feature_edge.end(), 1) - 2,
            std::count(mesh.feature_edge.begin(), mesh.feature_edge.end(), 1));
}

TEST(Sheets, CurvesEndWhereTheyBranchAndInAPlate) {
  const ControlMesh mesh = build(plate_with_fins());
  EXPECT_EQ(lengths_of_meetings(mesh), (std::multiset<std::size_t>{1, 1, 1, 1, 1}));
  EXPECT_EQ(number_sheets(mesh).count, 5);  // the plate, slit crosswise, stays whole
  EXPECT_TRUE(build(plate_with_fins(), {.boundary = BoundaryMode::free}).chains.size() == 5);

  OwnedPolygonMesh one = plate_with_fins();  // without the second fin
  one.corners.resize(one.corners.size() - 8);
  one.offsets.resize(one.offsets.size() - 2);
  EXPECT_EQ(lengths_of_meetings(build(one)), (std::multiset<std::size_t>{2}));
  EXPECT_EQ(lengths_of_meetings(build(one, {.corner_vertices = {12}})),
            (std::multiset<std::size_t>{1, 1}));
  for (const Chain& chain : build(one, {.boundary = BoundaryMode::linear}).chains)
    EXPECT_NE(chain.straight, chain.edges.size() == 2);
}

TEST(Sheets, CreasesMayBeNamedOnAnySheet) {
  const OwnedPolygonMesh mesh = two_cubes();
  for (const std::array<std::int64_t, 2> edge : {std::array<std::int64_t, 2>{6, 7}, {6, 11}}) {
    const ControlMesh creased = build(mesh, {.crease_edges = {edge}});
    EXPECT_EQ(crease_edges(creased).size(), 4u);
    for (const Index v : crease_edges(creased)) EXPECT_LT(v, creased.input_vertices);
  }
}

TEST(Sheets, PartsOfARegionAreTheSameOnAllThatMeet) {
  FeatureOptions features;
  features.region = {true, {0, 1}, RegionContinuity::tangent};  // two pages of three
  const ControlMesh mesh = make_control_mesh(three_on_an_edge().view(), features);
  for (Index e = 0; e < Index(mesh.edges.size()); ++e)
    EXPECT_TRUE(!mesh.nonmanifold(e) || mesh.edge_part(e) == RegionPart::joint);
  for (const Index v : {0, 1, 5, 6, 7, 8}) EXPECT_EQ(mesh.vertex_part(v), RegionPart::joint);
}

}  // namespace
}  // namespace fairing::test
