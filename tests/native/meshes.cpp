// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fairing::test {
namespace {

constexpr double pi = std::numbers::pi;

Point on_circle(double turn, double radius = 1, double z = 0) {
  return {radius * std::cos(2 * pi * turn), radius * std::sin(2 * pi * turn), z};
}

void scale_to_unit_sphere(OwnedPolygonMesh& mesh) {
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += 3) {
    double* p = &mesh.coordinates[i];
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (int axis = 0; axis < 3; ++axis) p[axis] /= length;
  }
}

}  // namespace

OwnedPolygonMesh make_mesh(const std::vector<Point>& points, const std::vector<Polygon>& faces) {
  OwnedPolygonMesh mesh;
  for (const Point& p : points) mesh.coordinates.insert(mesh.coordinates.end(), p.begin(), p.end());
  for (const Polygon& face : faces) {
    mesh.corners.insert(mesh.corners.end(), face.begin(), face.end());
    mesh.offsets.push_back(std::int64_t(mesh.corners.size()));
  }
  return mesh;
}

OwnedPolygonMesh tetrahedron() {
  auto mesh = make_mesh({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                        {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}});
  scale_to_unit_sphere(mesh);
  return mesh;
}

OwnedPolygonMesh cube() {
  return make_mesh(
      {{-1, -1, -1},
       {1, -1, -1},
       {1, 1, -1},
       {-1, 1, -1},
       {-1, -1, 1},
       {1, -1, 1},
       {1, 1, 1},
       {-1, 1, 1}},
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
}

OwnedPolygonMesh cube_triangles() {
  const OwnedPolygonMesh quads = cube();
  OwnedPolygonMesh mesh{quads.coordinates, {}, {0}};
  for (std::int64_t f = 0; f < 6; ++f) {
    const auto q = quads.view().face(f);
    for (const Polygon& t : {Polygon{q[0], q[1], q[2]}, Polygon{q[0], q[2], q[3]}}) {
      mesh.corners.insert(mesh.corners.end(), t.begin(), t.end());
      mesh.offsets.push_back(std::int64_t(mesh.corners.size()));
    }
  }
  return mesh;
}

OwnedPolygonMesh octahedron() {
  return make_mesh(
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}});
}

OwnedPolygonMesh icosahedron() {
  const double g = std::numbers::phi;
  auto mesh = make_mesh(
      {{-1, g, 0},
       {1, g, 0},
       {-1, -g, 0},
       {1, -g, 0},
       {0, -1, g},
       {0, 1, g},
       {0, -1, -g},
       {0, 1, -g},
       {g, 0, -1},
       {g, 0, 1},
       {-g, 0, -1},
       {-g, 0, 1}},
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}});
  scale_to_unit_sphere(mesh);
  return mesh;
}

// The dual of the icosahedron: a corner a triangle, a face a vertex.
OwnedPolygonMesh dodecahedron() {
  const OwnedPolygonMesh dual = icosahedron();
  std::vector<Point> points;
  for (std::int64_t f = 0; f < 20; ++f) {
    Point p{};
    for (std::int64_t v : dual.view().face(f))
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] += dual.coordinates[std::size_t(3 * v) + axis];
    points.push_back(p);
  }
  std::vector<Polygon> faces;
  for (std::int64_t v = 0; v < 12; ++v) {
    Polygon polygon;
    std::int64_t leading = -1, first = -1;  // the vertex after v in the current triangle
    do {
      for (std::int64_t f = 0; f < 20; ++f) {
        const auto t = dual.view().face(f);
        const auto i = std::size_t(std::find(t.begin(), t.end(), v) - t.begin());
        if (i == 3 || (leading >= 0 && t[(i + 1) % 3] != leading)) continue;
        polygon.push_back(f);
        if (first < 0) first = t[(i + 1) % 3];
        leading = t[(i + 2) % 3];
        break;
      }
    } while (leading != first);
    faces.push_back(polygon);
  }
  auto mesh = make_mesh(points, faces);
  scale_to_unit_sphere(mesh);
  return mesh;
}

OwnedPolygonMesh square_pyramid() {
  return make_mesh({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}},
                   {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
}

OwnedPolygonMesh torus(int around, int across) {
  std::vector<Point> points;
  std::vector<Polygon> faces;
  const auto id = [&](int i, int j) { return std::int64_t((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double angle = 2 * pi * j / across;
      points.push_back(on_circle(double(i) / around, 2 + std::cos(angle), std::sin(angle)));
      faces.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  return make_mesh(points, faces);
}

OwnedPolygonMesh two_tetrahedra() {
  OwnedPolygonMesh mesh = tetrahedron();
  const OwnedPolygonMesh other = tetrahedron();
  for (std::size_t i = 0; i < 12; ++i)
    mesh.coordinates.push_back(other.coordinates[i] + (i % 3 == 0 ? 5 : 0));
  for (std::int64_t v : other.corners) mesh.corners.push_back(v + 4);
  for (std::size_t f = 1; f < 5; ++f) mesh.offsets.push_back(other.offsets[f] + 12);
  return mesh;
}

OwnedPolygonMesh single_triangle() {
  return make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
}

OwnedPolygonMesh single_quad() {
  return make_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}});
}

OwnedPolygonMesh fan(int triangles) {
  OwnedPolygonMesh mesh = open_cone(triangles);
  mesh.coordinates[2] = 0;
  return mesh;
}

OwnedPolygonMesh half_fan(int triangles) {
  std::vector<Point> points{{0, 0, 0}};
  std::vector<Polygon> faces;
  for (int i = 0; i <= triangles; ++i) points.push_back(on_circle(0.5 * i / triangles));
  for (int i = 1; i <= triangles; ++i) faces.push_back({0, i, i + 1});
  return make_mesh(points, faces);
}

OwnedPolygonMesh grid(int columns, int rows) {
  std::vector<Point> points;
  std::vector<Polygon> faces;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) points.push_back({double(i), double(j), 0});
  const auto id = [&](int i, int j) { return std::int64_t(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      faces.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
  return make_mesh(points, faces);
}

OwnedPolygonMesh open_cone(int triangles) {
  std::vector<Point> points{{0, 0, 1}};
  std::vector<Polygon> faces;
  for (int i = 0; i < triangles; ++i) {
    points.push_back(on_circle(double(i) / triangles));
    faces.push_back({0, 1 + i, 1 + (i + 1) % triangles});
  }
  return make_mesh(points, faces);
}

OwnedPolygonMesh open_cylinder(int around) {
  std::vector<Point> points;
  std::vector<Polygon> faces;
  for (int i = 0; i < around; ++i) {
    points.push_back(on_circle(double(i) / around, 1, 0));
    points.push_back(on_circle(double(i) / around, 1, 1));
    const int j = (i + 1) % around;
    faces.push_back({2 * i, 2 * j, 2 * j + 1, 2 * i + 1});
  }
  return make_mesh(points, faces);
}

OwnedPolygonMesh roof() {
  return make_mesh({{0, 0, 1}, {2, 0, 1}, {0, -1, 0}, {2, -1, 0}, {0, 1, 0}, {2, 1, 0}},
                   {{2, 3, 1, 0}, {0, 1, 5, 4}});
}

OwnedPolygonMesh l_shape() {
  return make_mesh({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}},
                   {{0, 1, 2, 3, 4, 5}});
}

OwnedPolygonMesh u_shape() {
  return make_mesh(
      {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}},
      {{0, 1, 2, 3, 4, 5, 6, 7}});
}

OwnedPolygonMesh arrow() {
  return make_mesh({{0, 0, 0}, {2, -1, 0}, {0, 2, 0}, {0.2, 0.3, 0}}, {{0, 1, 2, 3}});
}

OwnedPolygonMesh flat_corner() {
  return make_mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {{0, 1, 2, 3}});
}

OwnedPolygonMesh warped_quad(double height) {
  return make_mesh({{0, 0, height}, {1, 0, 0}, {1, 1, height}, {0, 1, 0}}, {{0, 1, 2, 3}});
}

OwnedPolygonMesh quad_doublet() {
  return make_mesh({{-1, 0, 0}, {0, 0, 0.2}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}},
                   {{0, 1, 2, 3}, {2, 1, 0, 4}});
}

OwnedPolygonMesh triangulated(const OwnedPolygonMesh& quads) {
  OwnedPolygonMesh mesh{quads.coordinates, {}, {0}};
  for (std::int64_t f = 0; f < quads.view().face_count(); ++f) {
    const auto q = quads.view().face(f);
    mesh.corners.insert(mesh.corners.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
    mesh.offsets.push_back(mesh.offsets.back() + 3);
    mesh.offsets.push_back(mesh.offsets.back() + 3);
  }
  return mesh;
}

OwnedPolygonMesh waved(OwnedPolygonMesh mesh, double height) {
  std::vector<double>& x = mesh.coordinates;
  for (std::size_t i = 0; i < x.size(); i += 3) x[i + 2] += height * std::sin(2 * x[i] + x[i + 1]);
  return mesh;
}

}  // namespace fairing::test
