// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/validate/check.h"

#include <gtest/gtest.h>

#include <algorithm>

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

}  // namespace
}  // namespace fairing::test
