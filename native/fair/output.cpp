// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/output.h"

#include "execution/cancel.h"
#include "lattice/accumulate.h"

namespace fairing {
namespace {

// Ids of row j of a closed face.
void row_ids(const Lattice& lattice, Index f, bool quad, int j, std::vector<std::int32_t>& ids) {
  const int n = lattice.n(), last = quad ? n : n - j;
  ids.resize(std::size_t(last) + 1);
  const bool inside = j > 0 && j < n && last > 1;
  ids[0] = lattice.face_point(f, 0, j);
  ids[std::size_t(last)] = lattice.face_point(f, last, j);
  if (inside) {
    const Index first = lattice.face_point(f, 1, j);
    for (int i = 1; i < last; ++i) ids[std::size_t(i)] = first + i - 1;
  } else {
    for (int i = 1; i < last; ++i) ids[std::size_t(i)] = lattice.face_point(f, i, j);
  }
}

}  // namespace

OutputFaces make_faces(const Lattice& lattice, Workers& workers) {
  const ControlMesh& mesh = lattice.mesh();
  const int n = lattice.n();
  const std::size_t cells = std::size_t(n) * std::size_t(n);
  std::vector<std::size_t> place;  // among the faces of the same kind
  std::size_t triangles = 0, quads = 0;
  for (const Face& face : mesh.faces) place.push_back(face.quad() ? quads++ : triangles++);
  OutputFaces out;
  out.triangles.resize(3 * triangles * cells);
  out.triangle_polygon.resize(triangles * cells);
  out.quads.resize(4 * quads * cells);
  out.quad_polygon.resize(quads * cells);

  workers.for_parts(mesh.faces.size(), element_grain(n), [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> low, high;
    for (std::size_t f = begin; f < end; ++f) {
      const Face& face = mesh.faces[f];
      const bool quad = face.quad();
      std::int32_t* to = quad ? &out.quads[4 * place[f] * cells] : &out.triangles[3 * place[f] * cells];
      std::int32_t* polygon =
          quad ? &out.quad_polygon[place[f] * cells] : &out.triangle_polygon[place[f] * cells];
      std::fill(polygon, polygon + cells, std::int32_t(face.polygon));
      row_ids(lattice, Index(f), quad, 0, low);
      for (int j = 0; j < n; ++j) {
        stop_in_large_face(j);
        row_ids(lattice, Index(f), quad, j + 1, high);
        const auto width = std::size_t(quad ? n : n - j);
        for (std::size_t i = 0; i < width; ++i) {
          if (quad) {
            for (const std::int32_t id : {low[i], low[i + 1], high[i + 1], high[i]}) *to++ = id;
            continue;
          }
          for (const std::int32_t id : {low[i], low[i + 1], high[i]}) *to++ = id;
          if (i + 1 < width)
            for (const std::int32_t id : {low[i + 1], high[i + 1], high[i]}) *to++ = id;
        }
        std::swap(low, high);
      }
    }
  });
  return out;
}

}  // namespace fairing
