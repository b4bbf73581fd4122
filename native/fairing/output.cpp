// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/output.h"

#include <algorithm>

#include "base/points.h"
#include "fairing/joined_sheets.h"
#include "grid/accumulate.h"
#include "grid/linear.h"
#include "parallel/cancel.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Ids of row j of a closed face.
void row_ids(const GridLevel& grid, Index f, bool quad, int j, std::vector<std::int32_t>& ids) {
  const int n = grid.n(), last = quad ? n : n - j;
  ids.resize(std::size_t(last) + 1);
  const bool inside = j > 0 && j < n && last > 1;
  ids[0] = grid.face_point(f, 0, j);
  for (int i = 1; i < last; ++i)
    ids[i] = inside && i > 1 ? ids[std::size_t(i) - 1] + 1 : grid.face_point(f, i, j);
  ids[last] = grid.face_point(f, last, j);
}

void join_sheets(const JoinedSheets& joined, Workers& workers, Array<std::int32_t>& ids) {
  if (!joined.needed()) return;
  workers.for_each(ids.size(), vector_grain, [&](std::size_t k) { ids[k] = joined(ids[k]); });
}

}  // namespace

OutputFaces make_faces(const GridLevel& grid, Workers& workers) {
  const ControlMesh& mesh = grid.mesh();
  const int n = grid.n();
  const std::size_t cells = std::size_t(n) * std::size_t(n);
  std::vector<std::size_t> rank;  // number among faces of the same kind
  std::size_t triangles = 0, quads = 0;
  const auto faces = std::size_t(mesh.first_copied_face());
  for (std::size_t f = 0; f < faces; ++f)
    rank.push_back(mesh.faces[f].quad() ? quads++ : triangles++);
  OutputFaces out;
  out.triangles.resize(3 * triangles * cells);
  out.triangle_polygon.resize(triangles * cells);
  out.quads.resize(4 * quads * cells);
  out.quad_polygon.resize(quads * cells);

  workers.for_parts(faces, element_grain(n), [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> low, high;
    for (std::size_t f = begin; f < end; ++f) {
      const Face& face = mesh.faces[f];
      const bool quad = face.quad();
      std::int32_t* to =
          quad ? &out.quads[4 * rank[f] * cells] : &out.triangles[3 * rank[f] * cells];
      std::int32_t* polygon =
          quad ? &out.quad_polygon[rank[f] * cells] : &out.triangle_polygon[rank[f] * cells];
      std::fill(polygon, polygon + cells, std::int32_t(face.polygon));
      row_ids(grid, Index(f), quad, 0, low);
      for (int j = 0; j < n; ++j) {
        stop_in_large_face(j);
        row_ids(grid, Index(f), quad, j + 1, high);
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
  join_sheets(JoinedSheets(grid), workers, out.triangles);
  join_sheets(JoinedSheets(grid), workers, out.quads);
  return out;
}

Array<std::int32_t> crease_edges(const ControlMesh& mesh) {
  Array<std::int32_t> pairs;
  for (Index e = 0; e < mesh.first_copied_edge(); ++e) {
    const Edge& edge = mesh.edges[e];
    if (!mesh.feature_edge[e] || (edge.boundary() && !mesh.nonmanifold(e))) continue;
    for (const Index v : edge.vertex) pairs.push_back(mesh.original_vertex(v));
  }
  return pairs;
}

void to_world(const ControlPositions& control, const GridLevel& grid, const Frame& frame,
              Workers& workers, const double* x, double* world) {
  const ControlMesh& mesh = grid.mesh();
  const std::vector<Vec3>& given = control.world;
  std::vector<std::uint8_t> kept(given.size());
  for (const std::size_t v : Cancellable(given.size())) {
    kept[v] = point_at(x, Index(v)) == control.working[v];
  }
  workers.for_each(grid.size(), vector_grain / 3, [&](std::size_t p) {
    for (std::size_t a = 0; a < 3; ++a)
      world[3 * p + a] = frame.centre[a] + frame.scale * x[3 * p + a];
  });
  for (std::size_t v = 0; v < given.size(); ++v)
    if (kept[v]) put_point(given[v], world + 3 * v);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (control.world_curves.run[e] < 0) continue;
    double* to = world + 3 * std::size_t(grid.edge_base(Index(e)));
    for (const Vec3& p : control.world_curves.of(Index(e))) to = put_point(p, to);
  }
  refine_outside(grid, given, control.world_curves.run, world);
}

double largest_deviation(const std::vector<Vec3>& cage, const double* world) {
  double largest = 0;
  for (std::size_t v = 0; v < cage.size(); ++v)
    largest = std::max(largest, (point_at(world, Index(v)) - cage[v]).norm());
  return largest;
}

}  // namespace fairing
