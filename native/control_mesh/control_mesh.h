// SPDX-License-Identifier: GPL-3.0-or-later
// The control mesh: triangles and quads with edges, sides, one-rings and feature chains as flat tables.
// Built once through OpenMesh from checked arrays; all later rooms read these tables and nothing else.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "check/polygon_mesh.h"

namespace fairing {

using Index = std::int32_t;
using Vec3 = Eigen::Vector3d;

enum class BoundaryMode {
  curve,   // variational curve through the boundary's control vertices
  linear,  // the straight control edges
  free,    // natural boundary: the surface decides
};

// How a faired region meets what is outside it.
enum class Joint {
  position,   // in a fixed line, at any angle
  tangent,    // moreover with the outside's tangent planes
  curvature,  // moreover with the outside's curvature, which is none
};

struct RegionOptions {
  bool given = false;
  std::vector<std::int64_t> faces{};  // of the input
  Joint joint = Joint::tangent;
};

struct FeatureOptions {
  std::vector<std::array<std::int64_t, 2>> crease_edges{};  // vertex pairs, any order
  std::vector<std::int64_t> corner_vertices{};  // curves end here; an interior one may be a cone tip
  double crease_angle = -1.0;  // radians: edges folded by more than this are creases; negative: none
  double corner_angle = -1.0;  // radians: chains that turn by more than this are split; negative: none
  BoundaryMode boundary = BoundaryMode::curve;
  RegionOptions region{};
};

// A face's side s runs from its corner s to its corner s + 1.
struct Side {
  Index face;
  Index edge;
  std::int8_t local;  // s
  bool reversed;      // the side runs against its edge
};

struct Edge {
  std::array<Index, 2> vertex;
  std::array<Index, 2> side;  // [0] runs with the edge (face on its left), [1] against it; -1: none
  bool boundary() const { return side[0] < 0 || side[1] < 0; }
};

struct Face {
  std::array<Index, 4> vertex;  // counter-clockwise; vertex[3] == -1 for a triangle
  Index first_side;             // sides first_side … first_side + size - 1
  Index polygon;                // the input face that it is or comes from
  std::int8_t size;             // 3 or 4
  bool quad() const { return size == 4; }
};

// One spoke of a one-ring: an edge, and the face that follows it counter-clockwise.
struct Spoke {
  Index edge;
  Index face;          // -1 behind the last spoke of an open ring
  std::int8_t corner;  // the ring's centre is face.vertex[corner]
  bool outward;        // the centre is edge.vertex[0]
};

// A maximal run of feature edges between corners, or a closed loop without any corner.
struct Chain {
  std::vector<Index> vertices;  // m + 1 for m edges; a loop repeats no vertex (m vertices, m edges)
  std::vector<Index> edges;     // edges[k] joins vertices[k] and vertices[k + 1] (cyclically in a loop)
  bool closed = false;
  bool straight = false;  // BoundaryMode::linear: not smoothed
};

enum class Place : std::uint8_t { inside, joint, outside };

// Which part of the mesh is faired, where that is not all of it. What is not inside is refined linearly, and fixed.
struct Region {
  std::vector<Place> vertex, edge, face;  // a face is inside or outside; all empty: the whole mesh is inside
  Joint joint = Joint::tangent;
  // The joint edges that carry a fit, and their ends.
  std::vector<std::uint8_t> clamped_vertex, clamped_edge;

  bool whole() const { return face.empty(); }
};

struct ControlMesh {
  std::vector<Vec3> positions;  // input vertices first, then split centres
  Index input_vertices = 0;     // positions[input_vertices …] are free vertices that splits have added
  Index input_faces = 0;
  std::vector<Face> faces;
  std::vector<Side> sides;
  std::vector<Edge> edges;

  std::vector<Index> ring_offset;  // vertices + 1
  std::vector<Spoke> spokes;       // counter-clockwise; an open ring starts at its first boundary edge

  std::vector<Index> spoke_of_edge;  // [2 e + h]: the spoke at edge e's vertex h that is e
  std::vector<Index> spoke_of_side;  // the spoke at the side's first corner that is the side

  std::vector<std::uint8_t> feature_edge;    // per edge: lies on a curve (crease, or boundary unless free)
  std::vector<std::uint8_t> feature_vertex;  // per vertex: lies on a curve or is a corner; carries no fit
  std::vector<Chain> chains;
  Region region;

  Index vertex_count() const { return Index(positions.size()); }
  std::span<const Spoke> ring(Index v) const {
    return {spokes.data() + ring_offset[v], std::size_t(ring_offset[v + 1] - ring_offset[v])};
  }
  // True when the one-ring closes around v (v is not on the boundary and not isolated).
  bool interior(Index v) const {
    const auto r = ring(v);
    return !r.empty() && r.back().face >= 0;
  }

  Place vertex_place(Index v) const { return region.whole() ? Place::inside : region.vertex[std::size_t(v)]; }
  Place edge_place(Index e) const { return region.whole() ? Place::inside : region.edge[std::size_t(e)]; }
  Place face_place(Index f) const { return region.whole() ? Place::inside : region.face[std::size_t(f)]; }

  // Whether divided differences are taken at the control vertex, and at the points inside the edge.
  bool vertex_fit(Index v) const {
    return !ring(v).empty() && !feature_vertex[std::size_t(v)] && place_fit(vertex_place(v));
  }
  bool edge_fit(Index e) const { return !feature_edge[std::size_t(e)] && place_fit(edge_place(e)); }

 private:
  bool place_fit(Place place) const {
    return place == Place::inside || (place == Place::joint && region.joint != Joint::position);
  }
};

// `mesh` must have passed check(); `flipped` are the faces that check() says to reverse. Polygons of five and
// more sides, and quads too concave or warped, are split by shape (control_mesh/split.h).
// Throws FairingError: bad_feature_edge, index_out_of_range for creases, corners and a region's faces that are not in
// the mesh; bad_option for a region without faces;
// too_large for polygons that cannot be split (control_mesh/split.h).
ControlMesh make_control_mesh(const PolygonMesh& mesh, const FeatureOptions& features,
                              std::span<const std::int64_t> flipped = {});

}  // namespace fairing
