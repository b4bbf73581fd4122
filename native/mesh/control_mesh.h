// SPDX-License-Identifier: GPL-3.0-or-later
// The control mesh: triangles and quads with edges, half-edges (sides and spokes), one-rings and
// feature chains as flat tables. Built once, through OpenMesh, from checked arrays; all later code
// reads only these tables.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/types.h"
#include "mesh/polygon_mesh.h"

namespace fairing {

enum class BoundaryMode {
  curve,   // variational curve through the boundary's control vertices
  linear,  // the straight control edges
  free,    // natural boundary: the surface decides
};
constexpr std::size_t boundary_modes = 3;

// How a faired region meets its surroundings.
enum class RegionContinuity {
  position,   // in a fixed line, at any angle
  tangent,    // also with the same tangent planes
  curvature,  // also with the curvature of the outside, which is zero
};

struct RegionOptions {
  bool given = false;
  std::vector<std::int64_t> faces{};  // of the input
  RegionContinuity joint = RegionContinuity::tangent;
};

// Vertex pairs in any order, and a value for each.
using EdgeValues = std::pair<std::vector<std::array<std::int64_t, 2>>, std::vector<double>>;

struct FeatureOptions {
  std::vector<std::array<std::int64_t, 2>> crease_edges{};  // vertex pairs, any order
  EdgeValues soft_creases{};               // weights from 0, no crease, to 1, an ordinary crease
  std::vector<std::int64_t> flat_faces{};  // of the input
  // Curves end here; an interior one may be the tip of a cone.
  std::vector<std::int64_t> corner_vertices{};
  double crease_angle = -1.0;  // edges that fold by more are creases; radians; negative: none
  double corner_angle = -1.0;  // chains that turn by more are split there; radians; negative: none
  BoundaryMode boundary = BoundaryMode::curve;
  // Exceptions for single edges: under each mode, vertex pairs in any order; the last mode that
  // names an edge counts. Edges that are not on a boundary are ignored.
  std::array<std::vector<std::array<std::int64_t, 2>>, boundary_modes> boundary_edges{};
  RegionOptions region{};
};

// A half-edge of a face: side s runs from the face's corner s to its corner s + 1.
struct Side {
  Index face;
  Index edge;
  std::int8_t local;  // s
  bool reversed;      // opposite to its edge
};

struct Edge {
  std::array<Index, 2> vertex;
  // [0] has the edge's direction (face on its left), [1] the opposite one; -1: none
  std::array<Index, 2> side;
  bool boundary() const { return side[0] < 0 || side[1] < 0; }
};

struct Face {
  std::array<Index, 4> vertex;  // counter-clockwise; vertex[3] == -1 for a triangle
  Index first_side;             // sides first_side … first_side + size - 1
  Index polygon;                // the input face that it is or comes from
  std::int8_t size;             // 3 or 4
  bool quad() const { return size == 4; }
};

// A half-edge of a vertex: an edge of its one-ring, and the face that follows counter-clockwise.
struct Spoke {
  Index edge;
  Index face;          // -1 behind the last spoke of an open ring
  std::int8_t corner;  // the ring's centre is face.vertex[corner]
  bool outward;        // the centre is edge.vertex[0]
};

// A run of features, or of outlines of given flats, between corners; or a closed loop without any.
struct Chain {
  // Input vertices, and edges that are not copies.
  std::vector<Index> vertices;  // m + 1 for m edges; a loop repeats no vertex (m vertices, m edges)
  std::vector<Index> edges;     // edges[k] joins vertices[k] and [k + 1] (cyclically in a loop)
  bool closed = false;
  bool straight = false;  // of boundary edges under BoundaryMode::linear: not smoothed
};

enum class RegionPart : std::uint8_t { inside, joint, outside };

// Which part of the mesh is faired. The outside is refined linearly and fixed.
struct Region {
  // A face is inside or outside, never on the joint. All empty: the whole mesh is inside.
  std::vector<RegionPart> vertex, edge, face;
  RegionContinuity joint = RegionContinuity::tangent;
  // Joint edges with divided differences, and their ends.
  std::vector<std::uint8_t> clamped_vertex, clamped_edge;

  bool whole() const { return face.empty(); }
};

// Which elements of a control mesh are copies, and of which; ascending. Empty if the input is a
// manifold with two sides.
struct Copies {
  // Where sheets meet (mesh/sheets.h), each has its own vertices and edges. Control vertex
  // input_vertices + k is a copy of vertex[k]. The last edges are copies of `edge`, with the same
  // direction.
  std::vector<Index> vertex, edge;
  // A one-sided sheet is replaced by its double cover (mesh/double_cover.h), whose second half
  // consists of copies: vertices (flags `second`, per entry of `vertex`), edges, the last centres
  // and the last faces. Copied faces are reversed, with the same first corner.
  std::vector<std::uint8_t> second;
  std::vector<Index> centre, face;
};

// Soft creases (stencil/stiffness.h), with weights from 0 to 1.
struct SoftCreases {
  // Both empty: none. Of edges, at the midpoint; 0 on creases. Of vertices: the mean of the soft
  // edges where a line continues; 0 where it ends, but the edge's weight on a border; 1 on a
  // crease.
  std::vector<double> edge, vertex;

  bool any() const { return !edge.empty(); }
};

// Flat faces. All empty: none.
struct FlatFaces {
  // Those that stay plane, and edges and vertices with such faces only.
  std::vector<std::uint8_t> vertex, edge, face;
  // One a face: the direction in which it stays straight, in the mesh's coordinates, as one of a
  // strip that turns about it; zero: none. Such a face is not in `face`.
  std::vector<Vec3> along;
  std::vector<Index> part;  // one a face: the first face of its plane part

  bool is_straight(Index f) const { return !along.empty() && along[f] != Vec3::Zero(); }
  bool is_kept(Index f) const { return !face.empty() && (face[f] || is_straight(f)); }
  // Whether a face does not bend across a line in this direction. A straight one does not unless
  // the line is within 30 degrees of its direction: in inner corners, rims end at lines that are
  // some 35 from them.
  bool is_stiff(Index f, const Vec3& line) const {
    if (!is_straight(f)) return is_kept(f);
    const double both = along[f].dot(line);
    return both * both < 0.75 * line.squaredNorm();
  }
};

struct ControlMesh {
  // The input's vertices, their copies, free vertices of split polygons, their copies.
  std::vector<Vec3> positions;
  Index input_vertices = 0, input_faces = 0;
  std::vector<Face> faces;
  std::vector<Side> sides;
  std::vector<Edge> edges;

  Copies copies;

  // The one-rings, counter-clockwise; an open ring starts at its first boundary edge.
  std::vector<Index> ring_offset;  // vertices + 1
  std::vector<Spoke> spokes;

  std::vector<Index> spoke_of_edge;  // [2 e + h]: the spoke of edge e at its vertex h
  std::vector<Index> spoke_of_side;  // the spoke at the side's first corner along the side

  // Edges on a curve (a crease, or a boundary that is not free); vertices on a curve or at a
  // corner, which have no divided differences.
  std::vector<std::uint8_t> feature_edge, feature_vertex;
  std::vector<Chain> chains;       // of features, then of outlines of given flats
  std::size_t feature_chains = 0;  // number of the former
  SoftCreases soft;
  FlatFaces flat;
  Region region;

  Index vertex_count() const { return Index(positions.size()); }
  std::span<const Chain> features() const { return std::span(chains).first(feature_chains); }

  Index first_centre() const { return input_vertices + Index(copies.vertex.size()); }
  Index first_copied_centre() const { return vertex_count() - Index(copies.centre.size()); }
  Index first_copied_face() const { return Index(faces.size() - copies.face.size()); }
  Index first_copied_edge() const { return Index(edges.size() - copies.edge.size()); }
  // The input vertex at v, or the centre of a split polygon.
  Index original_vertex(Index v) const {
    if (v < input_vertices) return v;
    if (v < first_centre()) return copies.vertex[v - input_vertices];
    return v < first_copied_centre() ? v : copies.centre[v - first_copied_centre()];
  }
  Index original_edge(Index e) const {
    return e < first_copied_edge() ? e : copies.edge[e - first_copied_edge()];
  }
  // Whether v is a copy or has copies.
  bool shared(Index v) const {
    const std::vector<Index>& copied = v < first_centre() ? copies.vertex : copies.centre;
    return std::binary_search(copied.begin(), copied.end(), original_vertex(v));
  }
  // Whether the edge is a copy or has copies.
  bool shared_edge(Index e) const {
    return std::binary_search(copies.edge.begin(), copies.edge.end(), original_edge(e));
  }
  // Whether the edge is one of several at an input edge with three or more faces, rather than one
  // of two on a double cover.
  bool nonmanifold(Index e) const {
    const Index original = original_edge(e);
    const auto [first, last] = std::equal_range(copies.edge.begin(), copies.edge.end(), original);
    if (last - first != 1) return first != last;
    const Index copy = first_copied_edge() + Index(first - copies.edge.begin());
    return !second_vertex(edges[original].vertex[0]) && !second_vertex(edges[copy].vertex[0]);
  }
  // Whether several fans of faces meet at the input vertex of v.
  bool fans_meet(Index v) const {
    bool meet = false;
    if (v < first_centre())
      for_each_copy(original_vertex(v), [&](Index w) {
        meet |= w >= input_vertices && !copies.second[w - input_vertices];
      });
    return meet;
  }
  // Whether the element is in the second half of a double cover, which counts nowhere because it
  // repeats the first.
  bool second_vertex(Index v) const {
    return v < first_centre() ? v >= input_vertices && copies.second[v - input_vertices]
                              : v >= first_copied_centre();
  }
  bool second_edge(Index e) const { return e >= first_copied_edge() && !nonmanifold(e); }
  bool second_face(Index f) const { return f >= first_copied_face(); }
  // visit(v) for an input vertex and its copies.
  template <class Visit>
  void for_each_copy(Index v, Visit&& visit) const {
    visit(v);
    auto copy = std::lower_bound(copies.vertex.begin(), copies.vertex.end(), v);
    for (; copy != copies.vertex.end() && *copy == v; ++copy)
      visit(input_vertices + Index(copy - copies.vertex.begin()));
  }
  // Whether split_polygons has added the edge.
  bool inside_polygon(Index e) const {
    const auto polygon = [&](std::size_t h) { return faces[face_beside(e, h)].polygon; };
    return !edges[e].boundary() && polygon(0) == polygon(1);
  }

  // The face on the left (h = 0) or the right of an edge, which must have one there.
  Index face_beside(Index e, std::size_t h) const { return sides[edges[e].side[h]].face; }
  // The vertex at the other end of a spoke.
  Index end_of(const Spoke& spoke) const { return edges[spoke.edge].vertex[spoke.outward ? 1 : 0]; }

  std::span<const Spoke> ring(Index v) const {
    return {spokes.data() + ring_offset[v], std::size_t(ring_offset[v + 1] - ring_offset[v])};
  }
  // Whether the one-ring is closed (v is neither on the boundary nor isolated).
  bool interior(Index v) const {
    const auto r = ring(v);
    return !r.empty() && r.back().face >= 0;
  }

  RegionPart vertex_part(Index v) const {
    return region.whole() ? RegionPart::inside : region.vertex[v];
  }
  RegionPart edge_part(Index e) const {
    return region.whole() ? RegionPart::inside : region.edge[e];
  }
  RegionPart face_part(Index f) const {
    return region.whole() ? RegionPart::inside : region.face[f];
  }

  // Whether the surface has divided differences, and so bending, at the control vertex or at the
  // points inside the edge.
  bool vertex_fit(Index v) const {
    return !ring(v).empty() && !feature_vertex[v] && part_fit(vertex_part(v));
  }
  bool edge_fit(Index e) const { return !feature_edge[e] && part_fit(edge_part(e)); }

 private:
  bool part_fit(RegionPart part) const {
    return part == RegionPart::inside ||
           (part == RegionPart::joint && region.joint != RegionContinuity::position);
  }
};

// Number of points around a control vertex on any level: one per spoke, and one across each quad.
inline Index ring_size(const ControlMesh& mesh, Index v) {
  Index size = 0;
  for (const Spoke& spoke : mesh.ring(v))
    size += spoke.face >= 0 && mesh.faces[spoke.face].quad() ? 2 : 1;
  return size;
}

// `mesh` must have passed check(); `flipped` are the faces to reverse. Polygons of five and more
// sides, and quads too concave or warped, are split (mesh/split.h). Throws FairingError:
// bad_feature_edge, index_out_of_range for creases, boundary edges, corners and faces that are not
// in the mesh; bad_option for a region without faces; too_large for polygons that cannot be split.
ControlMesh make_control_mesh(const PolygonMesh& mesh, const FeatureOptions& features,
                              std::span<const std::int64_t> flipped = {});

}  // namespace fairing
