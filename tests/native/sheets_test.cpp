// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes whose sheets meet: what is cut, what is a copy of what, and the curves in between.
#include "mesh/sheets.h"

#include <gtest/gtest.h>

#include <set>

#include "control_mesh_invariants.h"
#include "curves/feature_curves.h"
#include "fairing/joined_sheets.h"
#include "fairing/output.h"
#include "mesh/validate/check.h"
#include "meshes.h"

namespace fairing::test {
namespace {

using Ids = std::vector<Index>;

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

TEST(Sheets, ThreePagesAtASpine) {
  const ControlMesh mesh = build(three_on_an_edge());
  EXPECT_EQ(mesh.copies.vertex, (Ids{0, 0, 1, 1}));
  EXPECT_EQ(mesh.copies.edge.size(), 2u);
  EXPECT_EQ(mesh.edges.size(), 9u);
  EXPECT_EQ(number_sheets(mesh).count, 3);
  EXPECT_EQ(lengths_of_meetings(mesh), (std::multiset<std::size_t>{1}));
  EXPECT_EQ(mesh.chains.size(), 4u);  // each page's boundary ends at the spine
  const JoinedVertices joined(mesh);
  for (const Index v : {0, 5, 6}) EXPECT_EQ(joined.first(v), 0);
  for (const Index v : {1, 7, 8}) EXPECT_EQ(joined.first(v), 1);
}

TEST(Sheets, CubesThatShareAnEdge) {
  const ControlMesh mesh = build(two_cubes());
  EXPECT_EQ(mesh.copies.vertex, (Ids{2, 6}));
  // Each cube closes again along the edge, which is a crease of both.
  ASSERT_EQ(mesh.copies.edge.size(), 1u);
  EXPECT_FALSE(mesh.edges.back().boundary());
  EXPECT_EQ(number_sheets(mesh).count, 2);
  EXPECT_EQ(lengths_of_meetings(mesh), (std::multiset<std::size_t>{1}));
  EXPECT_EQ(crease_edges(mesh).size(), 2u);
}

TEST(Sheets, AMobiusStripIsThereTwice) {
  const ControlMesh mesh = build(mobius(5));
  EXPECT_EQ(mesh.copies.vertex.size(), 10u);
  EXPECT_EQ(mesh.copies.second, std::vector<std::uint8_t>(10, 1));
  EXPECT_EQ(mesh.copies.face, (Ids{0, 1, 2, 3, 4}));
  EXPECT_EQ(mesh.copies.edge.size(), 15u);
  EXPECT_EQ(number_sheets(mesh).count, 1);
  ASSERT_EQ(mesh.chains.size(), 1u);  // one boundary
  EXPECT_TRUE(mesh.chains[0].closed);
  EXPECT_EQ(mesh.chains[0].edges.size(), 10u);
  for (Index e = 0; e < Index(mesh.edges.size()); ++e) EXPECT_FALSE(mesh.nonmanifold(e));
  EXPECT_TRUE(crease_edges(mesh).empty());
  for (int level = 0; level < 4; ++level) {
    const GridLevel grid(mesh, level);
    EXPECT_EQ(JoinedSheets(grid).size(), std::size_t(grid_size(10, 15, 0, 5, level)));
  }
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

TEST(Sheets, ConesThatTouchInAPoint) {
  const ControlMesh mesh = build(hourglass());
  EXPECT_EQ(mesh.copies.vertex, (Ids{0}));
  EXPECT_TRUE(mesh.copies.edge.empty() && mesh.chains.empty());
  EXPECT_TRUE(mesh.shared(0) && mesh.shared(mesh.input_vertices) && !mesh.shared(1));
  EXPECT_TRUE(mesh.interior(0) && mesh.interior(mesh.input_vertices));
  EXPECT_TRUE(mesh.vertex_fit(0));
  const JoinedVertices joined(mesh);
  EXPECT_NE(joined.first(0), joined.first(mesh.input_vertices));
}

// Sheets that only touch leave each other's boundaries alone.
TEST(Sheets, BoundariesRunThroughAPointTheyTouchIn) {
  EXPECT_EQ(build(two_fans()).chains.size(), 2u);
  for (const Chain& chain : build(two_fans()).chains) EXPECT_TRUE(chain.closed);
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

TEST(Sheets, CopiesTakeTheirCurveFromTheOriginal) {
  const ControlMesh mesh = build(plate_with_fins());
  const FeatureCurves curves = refine_feature_edges(mesh, 8, 0.5);
  for (Index e = mesh.first_copied_edge(); e < Index(mesh.edges.size()); ++e) {
    ASSERT_GE(curves.run[std::size_t(e)], 0);
    EXPECT_EQ(curves.of(e).data(), curves.of(mesh.original_edge(e)).data());
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

TEST(Sheets, WeldedPointsAreAllThereOnce) {
  for (const OwnedPolygonMesh& input :
       {three_on_an_edge(), two_cubes(), hourglass(), plate_with_fins(), grid(2, 2)}) {
    const ControlMesh mesh = build(input);
    const GridLevel grid(mesh, 2);
    const JoinedSheets joined(grid);
    EXPECT_EQ(joined.needed(), !mesh.copies.vertex.empty());
    std::vector<double> points(3 * grid.size()), welded(3 * joined.size());
    std::set<Index> ids;
    for (Index p = 0; p < Index(grid.size()); ++p) {
      ids.insert(joined(p));
      for (std::size_t a = 0; a < 3; ++a) points[3 * std::size_t(p) + a] = joined(p);
    }
    EXPECT_EQ(ids.size(), joined.size());
    EXPECT_EQ(std::size_t(*ids.rbegin()) + 1, joined.size());
    joined.join(points.data(), welded.data());
    for (std::size_t i = 0; i < welded.size(); ++i) EXPECT_EQ(welded[i], double(i / 3));
    joined.join(points.data(), points.data());
    EXPECT_TRUE(std::equal(welded.begin(), welded.end(), points.begin()));
  }
}

}  // namespace
}  // namespace fairing::test
