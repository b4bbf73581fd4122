// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's Polygon_mesh_processing::triangulate_refine_and_fair_hole on one hole of a triangle mesh.
//
// fairing_bench_fill_cgal MESH A B CONTINUITY OUT
//
// MESH and OUT as in cholesky.cpp; A and B are two neighbours on the rim. Weights and solver are
// CGAL's own choice. Prints the seconds of the processor that the call alone took.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <cstdio>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "cgal_mesh.h"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = Mesh::Vertex_index;

void write_mesh(const Mesh& mesh, const char* path) {
  std::ofstream out(path);
  out << std::setprecision(17) << mesh.number_of_vertices() << ' ' << mesh.number_of_faces()
      << '\n';
  for (const Vertex v : mesh.vertices()) out << mesh.point(v) << '\n';
  for (const auto f : mesh.faces()) {
    out << 3;
    for (const Vertex v : vertices_around_face(mesh.halfedge(f), mesh))
      out << ' ' << std::size_t(v);
    out << '\n';
  }
}

Mesh::Halfedge_index border(const Mesh& mesh, Vertex a, Vertex b) {
  for (const auto h : {mesh.halfedge(a, b), mesh.halfedge(b, a)})
    if (mesh.is_valid(h) && mesh.is_border(h)) return h;
  throw std::runtime_error("no border edge");
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 6) {
    std::fprintf(stderr, "usage: %s MESH A B CONTINUITY OUT\n", arguments[0]);
    return 2;
  }
  try {
    Mesh mesh = read_mesh<Mesh>(arguments[1]);
    const auto rim = border(mesh, Vertex(std::uint32_t(std::stoul(arguments[2]))),
                            Vertex(std::uint32_t(std::stoul(arguments[3]))));
    std::vector<Mesh::Face_index> faces;
    std::vector<Vertex> vertices;
    const std::clock_t start = std::clock();
    CGAL::Polygon_mesh_processing::triangulate_refine_and_fair_hole(
        mesh, rim, std::back_inserter(faces), std::back_inserter(vertices),
        CGAL::Polygon_mesh_processing::parameters::fairing_continuity(
            unsigned(std::stoul(arguments[4]))));
    std::printf("%.6g\n", double(std::clock() - start) / CLOCKS_PER_SEC);
    write_mesh(mesh, arguments[5]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
