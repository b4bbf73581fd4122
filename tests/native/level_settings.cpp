// SPDX-License-Identifier: GPL-3.0-or-later
#include "level_settings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "random.h"

namespace fairing::test {

ControlMesh control(const OwnedPolygonMesh& mesh, const FeatureOptions& features) {
  return make_control_mesh(mesh.view(), features);
}

OwnedPolygonMesh shaken(OwnedPolygonMesh mesh, double by) {
  std::mt19937 random(7);
  UniformReal<> move(-by, by);
  for (double& x : mesh.coordinates) x += move(random);
  return mesh;
}

OwnedPolygonMesh bipyramid(int k) {
  std::vector<Point> points{{0, 0, 1}, {0, 0, -1}};
  std::vector<Polygon> faces;
  for (int i = 0; i < k; ++i) {
    points.push_back({std::cos(2 * pi * i / k), std::sin(2 * pi * i / k), 0});
    faces.push_back({0, 2 + i, 2 + (i + 1) % k});
    faces.push_back({1, 2 + (i + 1) % k, 2 + i});
  }
  return make_mesh(points, faces);
}

OwnedPolygonMesh mixed_grid(int columns, int rows) {
  const OwnedPolygonMesh quads = grid(columns, rows);
  OwnedPolygonMesh mesh{quads.coordinates, {}, {0}};
  const auto add = [&](std::initializer_list<std::int64_t> face) {
    mesh.corners.insert(mesh.corners.end(), face);
    mesh.offsets.push_back(std::int64_t(mesh.corners.size()));
  };
  for (std::int64_t f = 0; f < quads.view().face_count(); ++f) {
    const auto q = quads.view().face(f);
    if (f % 2 == 0) {
      add({q[0], q[1], q[2], q[3]});
    } else if (f % 3 == 0) {
      add({q[0], q[1], q[2]});
      add({q[0], q[2], q[3]});
    } else {
      add({q[1], q[2], q[3]});
      add({q[1], q[3], q[0]});
    }
  }
  return mesh;
}

namespace {

std::map<std::string, ControlMesh> make_all() {
  std::map<std::string, ControlMesh> all;
  const FeatureOptions free{.boundary = BoundaryMode::free},
      linear{.boundary = BoundaryMode::linear};
  all["tetrahedron"] = control(shaken(tetrahedron()));
  all["cube"] = control(shaken(cube()));
  all["cube of triangles"] = control(shaken(cube_triangles()));
  all["octahedron"] = control(shaken(octahedron()));
  all["icosahedron"] = control(shaken(icosahedron()));
  all["pyramid"] = control(shaken(square_pyramid()));
  all["two components"] = control(two_tetrahedra());
  all["dodecahedron"] = control(shaken(dodecahedron(), 0.05));
  for (int k = 3; k <= 12; ++k)
    all["bipyramid " + std::to_string(k)] = control(shaken(bipyramid(k), 0.05));
  all["torus"] = control(shaken(torus(5, 4)));
  all["grid"] = control(shaken(grid(3, 2)));
  all["grid, free"] = control(shaken(grid(3, 2)), free);
  all["mixed grid"] = control(shaken(mixed_grid(4, 3)));
  all["mixed grid, free"] = control(shaken(mixed_grid(4, 3)), free);
  all["mixed grid, linear"] = control(shaken(mixed_grid(4, 3)), linear);
  all["mixed grid, dart"] =
      control(shaken(mixed_grid(3, 3)), {.crease_edges = {{5, 6}}, .corner_vertices = {9}});
  all["cylinder, free"] = control(shaken(open_cylinder(5)), free);
  all["cylinder"] = control(shaken(open_cylinder(5)));
  all["fan"] = control(shaken(fan(7)));
  all["fan, free"] = control(shaken(fan(7)), free);
  all["half fan, free"] = control(shaken(half_fan(5)), free);
  all["roof"] = control(roof(), {.crease_edges = {{0, 1}}});
  all["roof, free"] = control(shaken(roof()), free);
  all["crease"] = control(shaken(icosahedron()), {.crease_edges = {{0, 11}, {11, 2}}});
  all["triangle, free"] = control(single_triangle(), free);
  all["quad, free"] = control(single_quad(), free);
  all["triangle"] = control(single_triangle());
  OwnedPolygonMesh isolated = shaken(octahedron());
  isolated.coordinates.insert(isolated.coordinates.end(), {9, 9, 9});
  all["isolated vertex"] = control(isolated);
  return all;
}

}  // namespace

const std::map<std::string, ControlMesh>& all_meshes() {
  static const auto all = make_all();
  return all;
}

Unknowns all_points(const ControlMesh& mesh) {
  return {std::vector<std::uint8_t>(std::size_t(mesh.vertex_count()), 1),
          std::vector<std::uint8_t>(mesh.edges.size(), 1), true};
}

Unknowns some_points(const ControlMesh& mesh, int choice) {
  Unknowns u = all_points(mesh);
  u.any_vertex = false;
  for (std::size_t v = 0; v < u.vertex.size(); ++v) {
    u.vertex[v] = !mesh.feature_vertex[v] && (choice == 2 || (choice == 1 && v % 2 == 0));
    u.any_vertex |= u.vertex[v] != 0;
  }
  for (std::size_t e = 0; e < u.edge.size(); ++e) u.edge[e] = !mesh.feature_edge[e];
  return u;
}

Points random_points(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  UniformReal<> number(-1, 1);
  Points x(Eigen::Index(size), 3);
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] = number(random);
  return x;
}

Points masked(const GridLevel& grid, const Unknowns& unknowns, Points x) {
  const auto number = number_unknowns(grid, unknowns);
  for (std::size_t p = 0; p < number.size(); ++p)
    if (number[p] < 0) x.row(Eigen::Index(p)).setZero();
  return x;
}

FloatPoints with_room(const Points& x) {
  FloatPoints out = FloatPoints::Constant(x.rows() + Eigen::Index(vector_room), 3, 1e30f);
  out.topRows(x.rows()) = x.cast<float>();
  return out;
}

MakeCharts charts_of(double exponent, const PaperOptions& options) {
  return [=](const ControlMesh& mesh) { return make_charts(mesh, exponent, options); };
}

void on_all(int most_levels, const std::function<void(const Setting&, Workers&)>& body,
            const MakeCharts& make, double tension) {
  Workers workers(1);
  for (const auto& [name, mesh] : all_meshes())
    for (int level = 0; level <= most_levels; ++level) {
      SCOPED_TRACE(name + ", level " + std::to_string(level));
      const std::unique_ptr<ChartMaker> charts = make(mesh);
      body({mesh, GridLevel(mesh, level), *charts,
            make_stencils(mesh, *charts, workers, MembraneOptions{tension})},
           workers);
    }
}

}  // namespace fairing::test
