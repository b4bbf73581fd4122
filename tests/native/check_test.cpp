// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/validate/check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "meshes.h"
#include "thrown.h"

namespace fairing::test {
namespace {

using Ids = std::vector<std::int64_t>;

void expect_refused(const OwnedPolygonMesh& mesh, ErrorCode code, const Ids& elements,
                    CheckOptions options = {}) {
  const FairingError error = thrown([&] { check(mesh.view(), options); });
  EXPECT_STREQ(name(error.code), name(code));
  EXPECT_EQ(error.elements, elements);
  EXPECT_EQ(error.kind, elements.empty() ? ElementKind::mesh : usual_kind(code));
  EXPECT_GT(std::string(error.what()).size(), 20u);
}

TEST(Check, PassesCleanMeshes) {
  for (const OwnedPolygonMesh& mesh :
       {tetrahedron(),  cube(),           cube_triangles(), octahedron(),     icosahedron(),
        dodecahedron(), square_pyramid(), torus(6, 5),      two_tetrahedra(), single_triangle(),
        single_quad(),  two_triangles(),  fan(360),         half_fan(5),      grid(4, 3),
        open_cone(7),   open_cylinder(5), roof(),           l_shape(),        u_shape(),
        arrow(),        flat_corner(),    quad_doublet()}) {
    const CheckResult result = check(mesh.view());
    EXPECT_TRUE(result.warnings.empty());
    EXPECT_TRUE(result.flipped_faces.empty());
  }
}

TEST(Check, EveryCodeHasItsOwnName) {
  std::vector<std::string> names;
  for (int code = 0; code <= int(ErrorCode::cancelled); ++code)
    names.push_back(name(ErrorCode(code)));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
  EXPECT_EQ(std::count(names.begin(), names.end(), "UNKNOWN"), 0);
}

TEST(Check, Emptiness) {
  expect_refused({}, ErrorCode::empty_mesh, {});
  expect_refused({{}, {0, 1, 2}, {0, 3}}, ErrorCode::empty_mesh, {});
  expect_refused({{0, 0, 0}, {}, {0}}, ErrorCode::no_faces, {});
  expect_refused({{0, 0, 0}, {}, {}}, ErrorCode::no_faces, {});
}

TEST(Check, Shapes) {
  OwnedPolygonMesh mesh = two_triangles();
  mesh.coordinates.pop_back();
  expect_refused(mesh, ErrorCode::bad_shape, {});
  for (const Ids& offsets :
       {Ids{}, Ids{0}, Ids{0, 3}, Ids{1, 3, 6}, Ids{0, 7, 6}, Ids{0, -3, 6}, Ids{0, 3, 7}}) {
    mesh = two_triangles();
    mesh.offsets = offsets;
    expect_refused(mesh, ErrorCode::bad_shape, {});
  }
  mesh = two_triangles();
  mesh.offsets = {0, 3, 3, 4, 6};
  expect_refused(mesh, ErrorCode::bad_shape, {1, 2, 3});
}

TEST(Check, Coordinates) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), -1e200}) {
    OwnedPolygonMesh mesh = cube();
    mesh.coordinates[4] = mesh.coordinates[23] = bad;
    expect_refused(mesh, ErrorCode::non_finite, {1, 7});
  }
}

TEST(Check, Indices) {
  OwnedPolygonMesh mesh = cube();
  mesh.corners[5] = 8;
  mesh.corners[23] = -1;
  expect_refused(mesh, ErrorCode::index_out_of_range, {1, 5});
  mesh.corners[5] = std::numeric_limits<std::int64_t>::max();
  expect_refused(mesh, ErrorCode::index_out_of_range, {1, 5});
  mesh = cube();
  mesh.corners[6] = mesh.corners[4];
  expect_refused(mesh, ErrorCode::repeated_vertex, {1});
  mesh = tetrahedron();
  mesh.corners[2] = mesh.corners[0];
  expect_refused(mesh, ErrorCode::repeated_vertex, {0});
}

TEST(Check, DuplicateFaces) {
  expect_refused(pillow(), ErrorCode::duplicate_face, {0, 1});
  OwnedPolygonMesh mesh = cube();  // the same four corners in another order
  mesh.corners.insert(mesh.corners.end(), {5, 4, 6, 7});
  mesh.offsets.push_back(28);
  expect_refused(mesh, ErrorCode::duplicate_face, {1, 6});
}

void expect_warned(const OwnedPolygonMesh& mesh, const char* code, const Ids& elements) {
  const CheckResult result = check(mesh.view());
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_EQ(result.warnings[0].code, code);
  EXPECT_EQ(result.warnings[0].elements, elements);
}

TEST(Check, SheetsMayMeetAtEdges) {
  expect_warned(three_on_an_edge(), "NONMANIFOLD_EDGE", {0, 1});
  // Each sheet for itself: across the edge they need not agree, and all may be turned over.
  OwnedPolygonMesh mesh = three_on_an_edge();
  std::swap(mesh.corners[0], mesh.corners[1]);
  expect_warned(mesh, "NONMANIFOLD_EDGE", {0, 1});
}

TEST(Check, SheetsMayTouchAtVertices) {
  expect_warned(two_fans(), "NONMANIFOLD_VERTEX", {0});
  expect_warned(hourglass(), "NONMANIFOLD_VERTEX", {0});
  OwnedPolygonMesh mixed = hourglass();  // a closed and an open fan
  mixed.corners.resize(21);
  mixed.offsets.resize(8);
  mixed.corners.resize(18);
  mixed.offsets.resize(7);
  expect_warned(mixed, "NONMANIFOLD_VERTEX", {0});
  // Fans are counted whichever way the faces run.
  OwnedPolygonMesh turned = fan(6);
  std::swap(turned.corners[1], turned.corners[2]);
  std::swap(turned.corners[7], turned.corners[8]);
  EXPECT_EQ(check(turned.view(), {.repair = true}).flipped_faces, (Ids{0, 2}));
}

TEST(Check, Orientation) {
  expect_refused(flipped_cube_face(), ErrorCode::inconsistent_orientation, {2});
  EXPECT_EQ(check(flipped_cube_face().view(), {.repair = true}).flipped_faces, (Ids{2}));

  OwnedPolygonMesh mesh = two_tetrahedra();  // the fewest faces turn, in each component
  for (const std::size_t f : {0, 1, 3, 5})
    std::swap(mesh.corners[3 * f + 1], mesh.corners[3 * f + 2]);
  EXPECT_EQ(check(mesh.view(), {.repair = true}).flipped_faces, (Ids{2, 5}));

  mesh = grid(2, 1);  // where both parties are equal, the first face stays
  std::reverse(mesh.corners.begin() + 5, mesh.corners.end());
  EXPECT_EQ(check(mesh.view(), {.repair = true}).flipped_faces, (Ids{1}));
}

TEST(Check, AMobiusStripIsToldOfAndHasNoFacesToFlip) {
  expect_warned(mobius(5), "NON_ORIENTABLE", {0, 1, 2, 3, 4});
  EXPECT_TRUE(check(mobius(5).view(), {.repair = true}).flipped_faces.empty());
}

TEST(Check, DegenerateFaces) {
  OwnedPolygonMesh mesh = two_triangles();
  mesh.coordinates = {0, 0, 0, 1, 1, 0, 2, 2, 0, 0, 1, 0};
  expect_refused(mesh, ErrorCode::degenerate_face, {0});
  for (const double scale : {1e-6, 1e6}) {  // relative, and wherever it lies
    OwnedPolygonMesh thin = single_triangle();
    for (double& x : thin.coordinates) x *= scale;
    thin.coordinates[7] = 1e-9 * scale;
    EXPECT_NO_THROW(check(thin.view()));
    thin.coordinates[7] = 1e-13 * scale;
    expect_refused(thin, ErrorCode::degenerate_face, {0});
  }
  OwnedPolygonMesh far = grid(2, 2);
  for (double& x : far.coordinates) x = x * 1e-3 + 1e6;
  EXPECT_NO_THROW(check(far.view()));
}

TEST(Check, CoincidentVertices) {
  OwnedPolygonMesh mesh = two_triangles();
  std::copy_n(mesh.coordinates.begin(), 3, mesh.coordinates.begin() + 6);  // 2 onto 0
  mesh.coordinates[8] = -0.0;
  expect_refused(mesh, ErrorCode::coincident_vertices, {0, 2});

  OwnedPolygonMesh seam = grid(1, 1);  // a second quad beside it, not joined
  seam.coordinates.insert(seam.coordinates.end(), {1, 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0});
  seam.corners.insert(seam.corners.end(), {4, 5, 6, 7});
  seam.offsets.push_back(8);
  const CheckResult result = check(seam.view());
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_EQ(result.warnings[0].code, "COINCIDENT_VERTICES");
  EXPECT_EQ(result.warnings[0].elements, (Ids{1, 3, 4, 7}));
}

TEST(Check, IsolatedVerticesAreOnlyAWarning) {
  OwnedPolygonMesh mesh = single_triangle();
  mesh.coordinates.insert(mesh.coordinates.end(),
                          {0, 0, 0, 5, 5, 5});  // the first coincides with vertex 0
  const CheckResult result = check(mesh.view());
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_EQ(result.warnings[0].code, "ISOLATED_VERTICES");
  EXPECT_EQ(result.warnings[0].elements, (Ids{3, 4}));
}

TEST(Check, FindsEveryKindAtOnce) {
  OwnedPolygonMesh mesh = flipped_cube_face();
  mesh.coordinates.insert(mesh.coordinates.end(), {5, 5, 5});
  mesh.corners.insert(mesh.corners.end(), mesh.corners.begin() + 16, mesh.corners.begin() + 20);
  mesh.offsets.push_back(28);
  const Findings findings = find_defects(mesh.view());
  std::vector<ErrorCode> codes;
  for (const Defect& defect : findings.defects) codes.push_back(defect.code);
  EXPECT_EQ(codes,
            (std::vector{ErrorCode::duplicate_face, ErrorCode::nonmanifold_edge,
                         ErrorCode::inconsistent_orientation, ErrorCode::isolated_vertices}));
  EXPECT_EQ(findings.defects[0].elements, (Ids{4, 6}));
  EXPECT_EQ(findings.defects[1].elements.size(), 8u);
  EXPECT_EQ(findings.defects[2].elements, findings.flipped_faces);
  EXPECT_EQ(thrown([&] { check(mesh.view()); }).code, ErrorCode::duplicate_face);
}

TEST(Check, MessagesNameTheFirstFew) {
  EXPECT_NE(std::string(thrown([] { check(flipped_cube_face().view()); }).what())
                .find("1 face (2) points"),
            std::string::npos);
  const Warning joined = check(three_on_an_edge().view()).warnings.at(0);
  EXPECT_NE(text(joined.message, joined.kind, joined.elements).find("1 edge (0-1) joins"),
            std::string::npos);
}

}  // namespace
}  // namespace fairing::test
