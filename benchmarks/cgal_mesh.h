// SPDX-License-Identifier: GPL-3.0-or-later
// Triangle meshes for CGAL, read from files as in cholesky.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>

template <class Mesh>
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
    using Vertex = typename Mesh::Vertex_index;
    mesh.add_face(Vertex(corner[0]), Vertex(corner[1]), Vertex(corner[2]));
  }
  if (!in) throw std::runtime_error(std::string("cannot read ") + path);
  return mesh;
}
