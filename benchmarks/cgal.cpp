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
#include <stdexcept>
#include <string>
#include <vector>

#include "cgal_mesh.h"

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

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
    const Mesh mesh = read_mesh<Mesh>(arguments[1]);
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
