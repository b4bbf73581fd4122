// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/total_curvature.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "curvature/point_curvature.h"
#include "meshes.h"
#include "polyhedron.h"
#include "random.h"
#include "reference_rings.h"

namespace fairing::test {
namespace {

ControlMesh control(const OwnedPolygonMesh& mesh, const FeatureOptions& features = {}) {
  return make_control_mesh(mesh.view(), features);
}

// The convex hull of random points on the unit sphere.
OwnedPolygonMesh random_hull(int points, unsigned seed) {
  std::mt19937 random(seed);
  Normal<> normal;
  std::vector<Vec3> p;
  for (int i = 0; i < points; ++i) {
    const double z = normal(random), y = normal(random), x = normal(random);
    p.push_back(Vec3(x, y, z).normalized());
  }
  std::vector<Point> corners;
  for (const Vec3& q : p) corners.push_back({q.x(), q.y(), q.z()});
  std::vector<Polygon> faces;
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t j = 0; j < p.size(); ++j)
      for (std::size_t k = 0; k < p.size(); ++k) {
        if (i == j || k == j || i > j || i > k || k == i) continue;  // the lowest corner first
        const Vec3 outwards = (p[j] - p[i]).cross(p[k] - p[i]);
        bool hull = true;
        for (std::size_t m = 0; m < p.size() && hull; ++m)
          hull = m == i || m == j || m == k || outwards.dot(p[m] - p[i]) < 0;
        if (hull) faces.push_back({std::int64_t(i), std::int64_t(j), std::int64_t(k)});
      }
  return make_mesh(corners, faces);
}

std::map<std::string, ControlMesh> inscribed() {
  std::map<std::string, ControlMesh> all;
  all["tetrahedron"] = control(tetrahedron());
  all["cube"] = control(cube());
  all["cube of triangles"] = control(cube_triangles());
  all["octahedron"] = control(octahedron());
  all["icosahedron"] = control(icosahedron());
  all["dodecahedron"] = control(dodecahedron());
  for (unsigned seed = 1; seed <= 4; ++seed)
    all["hull of 12, " + std::to_string(seed)] = control(random_hull(12, seed));
  all["hull of 25"] = control(random_hull(25, 9));
  return all;
}

// The refined control polyhedron, projected to a sphere.
std::vector<double> on_sphere(const GridLevel& lattice, double radius,
                              const Vec3& centre = Vec3::Zero()) {
  std::vector<double> x(3 * lattice.size());
  refine_linearly(lattice, lattice.mesh().positions, x.data());
  for (std::size_t i = 0; i < x.size(); i += 3) {
    const Vec3 p(x[i], x[i + 1], x[i + 2]), q = centre + radius * p.normalized();
    for (int a = 0; a < 3; ++a) x[i + std::size_t(a)] = q[a];
  }
  return x;
}

// Every point that has a closed ring, found by walking around the cells.
void visit_rings(const GridLevel& lattice, const std::vector<double>& x,
                 const std::function<void(Index, const SurfaceRing&)>& visit) {
  const RingWalker walker(cells(lattice));
  const ChartMaker charts(lattice.mesh(), {});
  const auto at = [&](Index p) {
    return Vec3(Eigen::Map<const Vec3>(x.data() + 3 * std::size_t(p)));
  };
  visit_fits(lattice, walker, charts, [&](const ReferenceFit& fit) {
    if (fit.chart.ring.empty() || !fit.chart.closed) return;
    std::vector<Vec3> offset;
    std::vector<std::uint8_t> far;
    for (const RingNeighbour& r : fit.ring) {
      offset.push_back(at(r.point) - at(fit.centre));
      far.push_back(r.cell >= 0);
    }
    visit(fit.centre, {offset, far});
  });
}

double measured(const GridLevel& lattice, const std::vector<double>& x) {
  Workers workers(1);
  return total_curvature(lattice, workers, x.data());
}

TEST(PointCurvature, IsExactOnSpheres) {
  const Vec3 centre(0.2, -3, 1);
  const double radius = 1.7;
  for (const auto& [name, mesh] : inscribed())
    for (int level = 0; level <= 3; ++level) {
      SCOPED_TRACE(name + ", level " + std::to_string(level));
      const GridLevel lattice(mesh, level);
      const std::vector<double> x = on_sphere(lattice, radius, centre);
      std::size_t points = 0;
      SurfaceChart chart;
      visit_rings(lattice, x, [&](Index p, const SurfaceRing& ring) {
        const PointCurvature c = point_curvature(ring, chart);
        const Vec3 out = (Vec3(Eigen::Map<const Vec3>(x.data() + 3 * p)) - centre) / radius;
        EXPECT_LT((c.normal - out).norm(), 1e-11) << p;
        EXPECT_NEAR(c.trace, -2 / radius, 1e-9) << p;
        EXPECT_NEAR(c.trace_free[0], 0, 1e-8) << p;
        EXPECT_NEAR(c.trace_free[1], 0, 1e-8) << p;
        EXPECT_GT(c.area, 0) << p;
        ++points;
      });
      EXPECT_EQ(points, lattice.size());
    }
}

TEST(TotalCurvature, IsFiniteOnDegenerateSurfaces) {
  for (const OwnedPolygonMesh& faces : {cube(), icosahedron(), square_pyramid(), grid(3, 3)}) {
    const ControlMesh mesh = control(faces);
    const GridLevel lattice(mesh, 2);
    std::vector<double> x(3 * lattice.size(), 0.25);
    EXPECT_EQ(measured(lattice, x), 0);  // all in one point
    for (std::size_t i = 0; i < x.size(); i += 3) x[i] = 0.1 * double(i % 7);
    EXPECT_TRUE(std::isfinite(measured(lattice, x)));  // on a line
    for (std::size_t i = 0; i < x.size(); i += 3) x[i + 1] = double(i % 5) * 1e-13;
    EXPECT_TRUE(std::isfinite(measured(lattice, x)));
    std::mt19937 random(1);
    for (double& c : x) c = double(random() % 3);  // many zero-length edges, many folds
    EXPECT_TRUE(std::isfinite(measured(lattice, x)));
    for (double& c : x) c *= 1e-150;
    EXPECT_TRUE(std::isfinite(measured(lattice, x)));
    for (const double scale : {1e-60, 1e250}) {  // 1e-210, 1e40 in all
      for (double& c : x) c *= scale;
      EXPECT_TRUE(std::isfinite(measured(lattice, x)));
    }
    for (double& c : x) c *= 1e100;  // 1e140: what has burst must not seem to be flat
    EXPECT_EQ(measured(lattice, x), std::numeric_limits<double>::infinity());
  }
}

}  // namespace
}  // namespace fairing::test
