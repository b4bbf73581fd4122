// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/memory_counts.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "mesh/double_cover.h"
#include "mesh/groups.h"
#include "mesh/half_edges.h"
#include "mesh/sheets.h"
#include "mesh/validate/check.h"
#include "transfer/quadratic_matrix.h"

namespace fairing {
namespace {

// Thin: of triangles alone more than a fifth, otherwise more than a fortieth of the faces are longer
// than 16 times their area by length, as quads of 1 to 16 are.
void judge_shapes(const ControlMesh& mesh, Counts& c) {
  std::size_t thin = 0;
  for (const Face& face : mesh.faces) {
    const auto corner = [&](std::size_t i) { return mesh.positions[std::size_t(face.vertex[i])]; };
    const std::size_t size = face.quad() ? 4 : 3;
    double longest = 0, twice_area = 0;
    for (std::size_t i = 0; i < size; ++i)
      longest = std::max(longest, (corner((i + 1) % size) - corner(i)).squaredNorm());
    for (std::size_t i = 2; i < size; ++i)
      twice_area += (corner(i - 1) - corner(0)).cross(corner(i) - corner(0)).norm();
    thin += longest > 8 * twice_area;
  }
  c.thin = (c.quads > c.triangles ? 40 : 5) * thin > mesh.faces.size();
}

// Faces with the vertices that they have, numbered in order. Their places are nobody's concern.
OwnedPolygonMesh with_its_own_vertices(std::span<const std::int64_t> corners,
                                       std::span<const std::int64_t> offsets) {
  std::vector<std::int64_t> used(corners.begin(), corners.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  OwnedPolygonMesh mesh{std::vector<double>(3 * used.size()), {}, {offsets.begin(), offsets.end()}};
  mesh.corners.reserve(corners.size());
  for (const std::int64_t v : corners)
    mesh.corners.push_back(std::lower_bound(used.begin(), used.end(), v) - used.begin());
  return mesh;
}

// With polygons split around their centres, and one-sided sheets twice (mesh/double_cover.h).
void count_faces(const PolygonMesh& mesh, const DoubleCover& cover, Counts& c) {
  for (std::int64_t f = 0; f < mesh.face_count(); ++f) {
    const auto size = std::int64_t(mesh.face(f).size());
    const std::int64_t times = cover.has(std::int32_t(f)) ? 2 : 1;
    (size == 4 ? c.quads : c.triangles) += times * (size > 4 ? size : 1);
    if (size == 4) c.copied_quads += times - 1;
    if (size != 4) c.copied_triangles += (times - 1) * (size > 4 ? size : 1);
    if (size <= 4) continue;
    c.edges += times * size;
    c.free_edges += times * size;
    c.copied_edges += (times - 1) * size;
    c.vertices += times;
    c.free_vertices += times;
    c.copied_vertices += times - 1;
  }
}

// Those between corners. Where more than two faces meet, each has an edge of its own.
void count_edges(const HalfEdges& half_edges, const DoubleCover& cover, Counts& c) {
  for (std::int32_t k = 0; k < half_edges.count(); ++k) {
    if (half_edges.twin(k) > k) continue;
    const std::int64_t times = cover.has(half_edges.face(k)) ? 2 : 1;
    c.edges += times;
    c.free_edges += half_edges.twin(k) < 0 ? 0 : times;
    c.copied_edges += times - 1;
  }
  c.copied_edges += half_edges.sides_at_nonmanifold_edges() -
                    std::int64_t(half_edges.nonmanifold_edges().size()) / 2;
}

// Faces of each group.
std::vector<std::int64_t> sizes_of(Groups& groups, std::size_t faces) {
  std::vector<std::int64_t> of_lead(faces, 0);
  for (std::size_t f = 0; f < faces; ++f) ++of_lead[std::size_t(groups.lead(Index(f)))];
  std::erase(of_lead, 0);
  return of_lead;
}

std::vector<std::int64_t> parts_of(const HalfEdges& half_edges, std::size_t faces) {
  Groups groups(faces);
  for (std::int32_t k = 0; k < half_edges.count(); ++k)
    if (half_edges.twin(k) > k)
      groups.unite(half_edges.face(k), half_edges.face(half_edges.twin(k)));
  return sizes_of(groups, faces);
}

std::vector<std::int64_t> parts_of(const ControlMesh& mesh, const Unknowns& unknowns) {
  Groups groups(mesh.faces.size());
  const auto face_of = [&](Index side) { return mesh.sides[std::size_t(side)].face; };
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    if (unknowns.edge[e] && !mesh.edges[e].boundary())
      groups.unite(face_of(mesh.edges[e].side[0]), face_of(mesh.edges[e].side[1]));
  return sizes_of(groups, mesh.faces.size());
}

}  // namespace

Counts count_elements(std::int64_t vertices, std::span<const std::int64_t> corners,
                      std::span<const std::int64_t> offsets) {
  const OwnedPolygonMesh renumbered = with_its_own_vertices(corners, offsets);
  const PolygonMesh mesh = renumbered.view();
  const HalfEdges half_edges(mesh);
  const DoubleCover cover = begin_double_cover(mesh, half_edges);
  Counts c;
  c.vertices = vertices;
  c.lone = std::max<std::int64_t>(vertices - mesh.vertex_count(), 0);
  count_faces(mesh, cover, c);
  count_edges(half_edges, cover, c);
  c.free_triangles = c.triangles;
  c.free_quads = c.quads;
  c.parts = parts_of(half_edges, std::size_t(mesh.face_count()));
  for (std::int64_t f = 0; f < mesh.face_count(); ++f)  // refused, or mended before
    if (repeats_a_vertex(mesh.face(f))) return c;
  const auto copies = std::int64_t(count_copies(mesh, half_edges, cover));
  c.vertices += copies;
  c.copied_vertices += copies;
  return c;
}

Counts count_elements(const ControlMesh& mesh, const Unknowns& unknowns) {
  Counts c;
  c.vertices = mesh.vertex_count();
  c.edges = std::int64_t(mesh.edges.size());
  c.copied_vertices = std::int64_t(mesh.copies.vertex.size() + mesh.copies.centre.size());
  c.copied_edges = std::int64_t(mesh.copies.edge.size());
  c.free_vertices = std::count(unknowns.vertex.begin(), unknowns.vertex.end(), 1);
  c.free_edges = std::count(unknowns.edge.begin(), unknowns.edge.end(), 1);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const auto ring = std::int64_t(mesh.ring(v).size());
    c.lone += ring == 0;
    if (ring > std::int64_t(large_ring)) c.in_large_rings += ring * ring;
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const bool quad = mesh.faces[f].quad();
    ++(quad ? c.quads : c.triangles);
    (quad ? c.free_quads : c.free_triangles) += unknowns.has_face(f);
  }
  for (const Index f : mesh.copies.face)
    ++(mesh.faces[std::size_t(f)].quad() ? c.copied_quads : c.copied_triangles);
  c.parts = parts_of(mesh, unknowns);
  judge_shapes(mesh, c);
  return c;
}

}  // namespace fairing
