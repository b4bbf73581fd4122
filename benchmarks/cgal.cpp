// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's Polygon_mesh_processing::fair on a refined triangle mesh whose first vertices stay.
//
// fairing_bench_cgal MESH FIXED REPEATS
//
// MESH as in cholesky.cpp. Continuity C1 is the bi-Laplacian; weights and solver are CGAL's own
// choice (Eigen's SparseLU). Prints one JSON object; what is timed is the call alone, neither
// reading nor connecting the mesh.
#include <CGAL/Polygon_mesh_processing/fair.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

Mesh read_mesh(const char* path) {
  std::ifstream in(path);
  std::size_t vertices = 0, faces = 0;
  in >> vertices >> faces;
  Mesh mesh;
  for (std::size_t v = 0; v < vertices; ++v) {
    double x = 0, y = 0, z = 0;
    in >> x >> y >> z;
    mesh.add_vertex({x, y, z});
  }
  for (std::size_t f = 0; f < faces; ++f) {
    std::uint32_t size = 0, corner[3];
    in >> size >> corner[0] >> corner[1] >> corner[2];
    if (size != 3) throw std::runtime_error("only triangles");
    mesh.add_face(Mesh::Vertex_index(corner[0]), Mesh::Vertex_index(corner[1]),
                  Mesh::Vertex_index(corner[2]));
  }
  if (!in) throw std::runtime_error(std::string("cannot read ") + path);
  return mesh;
}

double seconds_to_fair(Mesh mesh, std::size_t fixed) {
  std::vector<Mesh::Vertex_index> free;
  for (const auto v : mesh.vertices())
    if (std::size_t(v) >= fixed) free.push_back(v);
  const auto start = std::chrono::steady_clock::now();
  const bool solved = CGAL::Polygon_mesh_processing::fair(
      mesh, free, CGAL::Polygon_mesh_processing::parameters::fairing_continuity(1));
  if (!solved) throw std::runtime_error("CGAL could not solve the system");
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 4) {
    std::fprintf(stderr, "usage: %s MESH FIXED REPEATS\n", arguments[0]);
    return 2;
  }
  try {
    const Mesh mesh = read_mesh(arguments[1]);
    std::printf("{\"wall\": [");
    for (int r = 0; r < std::stoi(arguments[3]); ++r)
      std::printf("%s%.6g", r ? ", " : "", seconds_to_fair(mesh, std::stoul(arguments[2])));
    std::printf("]}\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
