// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever passes the check can be built, and all the rest is refused by name.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "control_mesh_invariants.h"
#include "mesh/control_mesh.h"
#include "mesh/validate/check.h"
#include "meshes.h"
#include "random.h"

namespace fairing::test {
namespace {

struct Dice {
  std::mt19937 random;
  int operator()(int from, int to) { return UniformInt(from, to)(random); }
};

OwnedPolygonMesh random_soup(Dice& dice) {
  const int vertices = dice(3, 9), faces = dice(1, 7);
  std::vector<Point> points;
  Normal<> coordinate;
  for (int v = 0; v < vertices; ++v)
    points.push_back({coordinate(dice.random), coordinate(dice.random), coordinate(dice.random)});
  std::vector<Polygon> polygons;
  Polygon order(static_cast<std::size_t>(vertices));
  std::iota(order.begin(), order.end(), 0);
  for (int f = 0; f < faces; ++f) {
    shuffle_things(order, dice.random);
    polygons.emplace_back(order.begin(), order.begin() + dice(3, std::min(6, vertices)));
  }
  return make_mesh(points, polygons);
}

// Starts from a manifold and does it little harm: most of these pass, and bring odd connectivity.
OwnedPolygonMesh random_manifold(Dice& dice) {
  const OwnedPolygonMesh whole[] = {icosahedron(), cube(),         torus(3, 3),
                                    grid(3, 2),    dodecahedron(), octahedron()};
  const PolygonMesh view = whole[dice(0, 5)].view();
  std::vector<Polygon> faces;
  for (std::int64_t f = 0; f < view.face_count(); ++f) {
    if (dice(0, 9) == 0) continue;  // a hole
    Polygon face(view.face(f).begin(), view.face(f).end());
    std::rotate(face.begin(), face.begin() + dice(0, int(face.size()) - 1), face.end());
    if (dice(0, 19) == 0) std::reverse(face.begin(), face.end());
    faces.push_back(face);
  }
  // Joining two faces along an edge gives polygons, and now and then vertices of valence two.
  for (int joins = dice(0, 6); joins > 0 && faces.size() > 1; --joins) {
    const auto f = std::size_t(dice(0, int(faces.size()) - 1));
    Polygon a = faces[f];
    const auto g = std::find_if(faces.begin(), faces.end(), [&](const Polygon& b) {
      if (b == a) return false;
      for (std::size_t i = 0; i < b.size(); ++i)
        if (b[i] == a[1] && b[(i + 1) % b.size()] == a[0]) return true;
      return false;
    });
    if (g == faces.end()) continue;
    Polygon b = *g;
    std::rotate(b.begin(), std::find(b.begin(), b.end(), a[0]), b.end());  // a0 … a1
    a.insert(a.begin() + 1, b.begin() + 1, b.end() - 1);
    faces[f] = a;
    faces.erase(g);
  }
  shuffle_things(faces, dice.random);
  OwnedPolygonMesh mesh = make_mesh({}, faces);
  Normal<> noise(0, 0.1);
  for (double x : view.coordinates) mesh.coordinates.push_back(x + noise(dice.random));
  return mesh;
}

FeatureOptions random_features(Dice& dice, const OwnedPolygonMesh& mesh) {
  FeatureOptions options;
  options.boundary = BoundaryMode(dice(0, 2));
  if (dice(0, 1)) options.crease_angle = 0.1 * dice(0, 20);
  if (dice(0, 1)) options.corner_angle = 0.1 * dice(0, 20);
  if (dice(0, 1)) options.corner_vertices.push_back(mesh.corners[0]);
  if (dice(0, 1)) options.crease_edges.push_back({mesh.corners[0], mesh.corners[1]});
  return options;
}

std::map<std::string, int> outcomes(OwnedPolygonMesh (*make)(Dice&), int trials) {
  std::map<std::string, int> count;
  Dice dice{std::mt19937(7)};
  for (int trial = 0; trial < trials && !testing::Test::HasFailure(); ++trial) {
    SCOPED_TRACE(trial);
    const OwnedPolygonMesh mesh = make(dice);
    try {
      const CheckResult result = check(mesh.view(), {.repair = dice(0, 1) == 1});
      ++count["passed"];
      const ControlMesh control =
          make_control_mesh(mesh.view(), random_features(dice, mesh), result.flipped_faces);
      expect_consistent(control);
      if (!control.copies.face.empty()) ++count["one-sided"];
    } catch (const FairingError& error) {
      ++count[name(error.code)];
      EXPECT_FALSE(error.elements.empty());
      EXPECT_NE(error.code, ErrorCode::bad_feature_edge);
    }
  }
  for (const auto& [code, times] : count) testing::Test::RecordProperty(code, times);
  return count;
}

TEST(Soup, RandomFacesOnFewVertices) {
  const auto count = outcomes(random_soup, 20000);
  EXPECT_GT(count.at("passed"), 1000);
  EXPECT_GT(count.at("one-sided"), 10);
}

TEST(Soup, DamagedManifolds) {
  const auto count = outcomes(random_manifold, 5000);
  EXPECT_GT(count.at("passed"), 1000);
  EXPECT_EQ(count.count("one-sided"), 0u);
}

}  // namespace
}  // namespace fairing::test
