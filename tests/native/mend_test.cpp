// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mend/mend.h"

#include <gtest/gtest.h>

#include "meshes.h"
#include "parallel/cancel.h"

namespace fairing::test {
namespace {

std::vector<Polygon> faces_of(const MendedMesh& mended) {
  std::vector<Polygon> faces;
  const PolygonMesh mesh = mended.mesh.view();
  for (std::int64_t f = 0; f < mesh.face_count(); ++f)
    faces.emplace_back(mesh.face(f).begin(), mesh.face(f).end());
  return faces;
}

// Flat faces in a fan on one line: the face beside them gets a vertex of each. Whatever goes through
// corners asks at every 1024th.
TEST(Mend, AFanOfFlatFacesTakesLinearTime) {
  constexpr std::int64_t count = 20000;
  OwnedPolygonMesh mesh;
  for (std::int64_t k = 0; k <= count; ++k)
    mesh.coordinates.insert(mesh.coordinates.end(), {double(k), 0, 0});
  mesh.coordinates.insert(mesh.coordinates.end(), {count / 2.0, double(count), 0});
  const auto add = [&](std::int64_t a, std::int64_t b, std::int64_t c) {
    mesh.corners.insert(mesh.corners.end(), {a, b, c});
    mesh.offsets.push_back(std::int64_t(mesh.corners.size()));
  };
  for (std::int64_t k = 1; k < count; ++k) add(0, k, k + 1);
  add(0, count + 1, count);
  Monitor monitor;
  const CancelScope scope(&monitor);
  monitor.cancel_at_question(1000);
  const std::vector<Polygon> faces = faces_of(mend(mesh.view()));
  ASSERT_EQ(faces.size(), 1u);
  EXPECT_EQ(faces[0].size(), std::size_t(count + 2));
}

TEST(Mend, CanBeCancelledAtEveryQuestion) {
  OwnedPolygonMesh mesh = triangulated(torus(60, 40));
  mesh.corners.insert(mesh.corners.end(), {0, 1, 1, 0, 1, 2});
  mesh.offsets.insert(mesh.offsets.end(),
                      {std::int64_t(mesh.corners.size()) - 3, std::int64_t(mesh.corners.size())});
  int cancelled = 0;
  for (std::int64_t question = 1;; ++question) {
    Monitor monitor;
    monitor.cancel_at_question(question);
    const CancelScope scope(&monitor);
    try {
      mend(mesh.view(), {.weld = 0});
      break;
    } catch (const FairingError& error) {
      ASSERT_EQ(error.code, ErrorCode::cancelled);
      ++cancelled;
    }
  }
  EXPECT_GT(cancelled, 20);
}

}  // namespace
}  // namespace fairing::test
