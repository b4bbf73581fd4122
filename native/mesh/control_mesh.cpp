// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/control_mesh.h"

#include <OpenMesh/Core/Mesh/PolyConnectivity.hh>
#include <string>

#include "base/error.h"
#include "base/points.h"
#include "mesh/features.h"
#include "mesh/flat_faces.h"
#include "mesh/orientation.h"
#include "mesh/region.h"
#include "mesh/sheets.h"
#include "mesh/split.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

void set_faces(const SplitMesh& split, ControlMesh& control) {
  Index sides = 0;
  control.faces.reserve(split.faces.size());
  for (const SplitFace& face : split.faces) {
    stop_if_cancelled(control.faces.size());
    const auto size = std::int8_t(face.vertex[3] < 0 ? 3 : 4);
    control.faces.push_back({face.vertex, sides, face.polygon, size});
    sides += size;
  }
  control.sides.reserve(std::size_t(sides));
}

// --- edges, sides and rings, by OpenMesh, which only fill/refine.cpp uses as well ---

// Half-edges without positions. Only handles and prev/next/opposite are used, since the sense of
// circulators differs between versions of OpenMesh.
using HalfEdgeMesh = OpenMesh::PolyConnectivity;
using Half = OpenMesh::HalfedgeHandle;

// The half-edge from v that follows h counter-clockwise around v.
Half rotated(const HalfEdgeMesh& mesh, Half h) {
  return mesh.opposite_halfedge_handle(mesh.prev_halfedge_handle(h));
}

HalfEdgeMesh build(const ControlMesh& control) {
  HalfEdgeMesh mesh;
  mesh.reserve(control.positions.size(), control.positions.size() + control.faces.size(),
               control.faces.size());
  for (std::size_t v = 0; v < control.positions.size(); ++v) mesh.add_vertex();
  for (const std::size_t f : Cancellable(control.faces.size())) {
    const Face& face = control.faces[f];
    OpenMesh::VertexHandle corners[4];
    for (int i = 0; i < face.size; ++i) corners[i] = OpenMesh::VertexHandle(face.vertex[i]);
    // check() excludes failures here; but a bug must not produce a broken table.
    if (!mesh.add_face(corners, std::size_t(face.size)).is_valid())
      throw FairingError(
          ErrorCode::nonmanifold_vertex,
          "Face " + std::to_string(face.polygon) + " cannot be joined to its neighbours.",
          {face.polygon}, ElementKind::face);
  }
  return mesh;
}

void fill_edges(const HalfEdgeMesh& mesh, ControlMesh& control) {
  control.edges.resize(mesh.n_edges());
  for (const std::size_t e : Cancellable(control.edges.size())) {
    const Half h = mesh.halfedge_handle(OpenMesh::EdgeHandle(int(e)), 0);
    control.edges[e] = {{mesh.from_vertex_handle(h).idx(), mesh.to_vertex_handle(h).idx()},
                        {-1, -1}};
  }
}

// OpenMesh's half-edges 2e and 2e + 1 are the directions of the edge, in the order of Edge::side.
void fill_sides(const HalfEdgeMesh& mesh, ControlMesh& control) {
  for (const std::size_t f : Cancellable(control.faces.size())) {
    const Face& face = control.faces[f];
    Half h = mesh.halfedge_handle(OpenMesh::FaceHandle(int(f)));
    while (mesh.from_vertex_handle(h).idx() != face.vertex[0]) h = mesh.next_halfedge_handle(h);
    for (int s = 0; s < face.size; ++s, h = mesh.next_halfedge_handle(h)) {
      const Index e = h.idx() / 2;
      const bool reversed = h.idx() % 2 != 0;
      control.edges[e].side[reversed] = Index(control.sides.size());
      control.sides.push_back({Index(f), e, std::int8_t(s), reversed});
    }
  }
}

void fill_ring(const HalfEdgeMesh& mesh, Index v, ControlMesh& control) {
  const OpenMesh::VertexHandle centre(v);
  if (mesh.is_isolated(centre)) return;
  // A boundary vertex refers to its boundary half-edge, with no face behind it: the last spoke.
  const Half last = mesh.halfedge_handle(centre);
  const bool open = mesh.is_boundary(last);
  Half first = last;
  if (open)
    while (!mesh.is_boundary(mesh.opposite_halfedge_handle(first)))
      first = mesh.next_halfedge_handle(mesh.opposite_halfedge_handle(first));
  Half h = first;
  do {
    const auto direction = std::size_t(h.idx() % 2);
    const Index side = control.edges[h.idx() / 2].side[direction];
    Spoke spoke{h.idx() / 2, -1, -1, direction == 0};
    if (side >= 0) {
      spoke.face = control.sides[side].face;
      spoke.corner = control.sides[side].local;
    }
    control.spokes.push_back(spoke);
    if (spoke.face < 0) break;
    h = rotated(mesh, h);
  } while (h != first);
}

// Fills the tables of sides, edges and rings from the faces.
void connect_faces(ControlMesh& control) {
  const HalfEdgeMesh mesh = build(control);
  fill_edges(mesh, control);
  fill_sides(mesh, control);
  control.ring_offset.assign(1, 0);
  for (const Index v : Cancellable(control.vertex_count())) {
    fill_ring(mesh, v, control);
    control.ring_offset.push_back(Index(control.spokes.size()));
  }
}

// Fills the places of edges and sides in the rings of their vertices.
void index_spokes(ControlMesh& control) {
  control.spoke_of_edge.resize(2 * control.edges.size());
  control.spoke_of_side.resize(control.sides.size());
  for (const std::size_t k : Cancellable(control.spokes.size())) {
    const Spoke& spoke = control.spokes[k];
    control.spoke_of_edge[2 * std::size_t(spoke.edge) + (spoke.outward ? 0 : 1)] = Index(k);
    if (spoke.face < 0) continue;
    const Face& face = control.faces[spoke.face];
    control.spoke_of_side[face.first_side + spoke.corner] = Index(k);
  }
}

}  // namespace

ControlMesh make_control_mesh(const PolygonMesh& mesh, const FeatureOptions& features,
                              std::span<const std::int64_t> flipped) {
  OwnedPolygonMesh sheets = with_flipped(mesh, flipped);
  ControlMesh control;
  control.input_vertices = Index(mesh.vertex_count());
  control.input_faces = Index(mesh.face_count());
  SheetCopies copies = cut_into_sheets(sheets);
  control.copies.vertex = std::move(copies.vertex);
  control.copies.second = std::move(copies.second);
  SplitMesh split = split_polygons(sheets.view(), control.copies.vertex);
  control.copies.face = lift_faces(sheets.view(), copies.cover, split, control.copies.centre);

  for (Index v = 0; v < control.first_centre(); ++v)
    control.positions.push_back(point_at(sheets.coordinates, v));
  control.positions.insert(control.positions.end(), split.centres.begin(), split.centres.end());
  set_faces(split, control);
  connect_faces(control);
  find_copied_edges(control);
  index_spokes(control);
  find_region(features.region, control);
  find_features(sheets.view(), features, control);
  mark_flat_faces(features.flat_faces, control);
  mark_clamped_joint(control);
  return control;
}

}  // namespace fairing
