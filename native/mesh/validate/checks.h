// SPDX-License-Identifier: GPL-3.0-or-later
// The single checks of check(), for mesh/validate/ and mesh/mend/ only. Each adds its defects with
// *all* elements concerned. Linear time up to sorting. All may throw std::bad_alloc and
// FairingError(cancelled).
#pragma once

#include "mesh/half_edges.h"
#include "mesh/orientation.h"
#include "mesh/validate/check.h"
#include "parallel/cancel.h"

namespace fairing {

// The faces that satisfy `predicate`, given their vertices.
template <class Predicate>
std::vector<std::int64_t> faces_where(const PolygonMesh& mesh, const Predicate& predicate) {
  std::vector<std::int64_t> found;
  for (const std::int64_t f : Cancellable(mesh.face_count())) {
    if (predicate(mesh.face(f))) found.push_back(f);
  }
  return found;
}

// --- arrays.cpp: whether the arrays describe faces at all ---

// Assumptions that later tests may make.
struct Readable {
  bool faces = false;        // ids in range and of 32 bits, three corners or more
  bool simple = false;       // also, no face has a vertex twice
  bool coordinates = false;  // all finite
};

// Adds empty_mesh, no_faces, bad_shape, too_large, non_finite, index_out_of_range, repeated_vertex.
Readable check_arrays(const PolygonMesh& mesh, Defects& found);

// Whether a face has an id that is not one of so many vertices.
bool names_absent_vertex(std::span<const std::int64_t> face, std::int64_t vertices);

// Per vertex, 1 if a face has it; faces with missing vertices do not count.
std::vector<std::uint8_t> used_vertices(const PolygonMesh& mesh);

// --- topology.cpp: whether the faces form oriented sheets, and where these meet ---

// A face, and the first one with the same vertex set, in any order: itself, or an earlier one.
struct SameVertices {
  std::int32_t face, first;
};

// All faces that share their vertex set, ascending.
std::vector<SameVertices> faces_with_same_vertices(const PolygonMesh& mesh);

// Adds duplicate_face (same vertex set, in any order) with all faces concerned.
void check_duplicate_faces(const PolygonMesh& mesh, Defects& found);

// Adds nonmanifold_edge (vertex pairs), a warning: sheets meet there (mesh/sheets.h).
void check_nonmanifold_edges(const HalfEdges& half_edges, Defects& found);

// Adds nonmanifold_vertex, a warning, for any orientation. Ends of nonmanifold edges are left out,
// because the edges are reported.
void check_nonmanifold_vertices(const PolygonMesh& mesh, const HalfEdges& half_edges,
                                Defects& found);

// Adds non_orientable and inconsistent_orientation, the latter as a warning if it will be repaired.
void check_orientation(const Orientation& orientation, bool repair, Defects& found);

// --- geometry.cpp: whether the faces have an extent, and which vertices share a point ---

// Area below 1e-12 of the longest side squared.
bool has_no_area(std::span<const double> coordinates, std::span<const std::int64_t> face);

// Adds coincident_vertices: an error for vertices of one face at one point; a warning for other
// vertices that share a point (seams).
void check_coincident_vertices(const PolygonMesh& mesh, Defects& found);

// Adds degenerate_face: those that has_no_area.
void check_areas(const PolygonMesh& mesh, Defects& found);

// Adds isolated_vertices, a warning.
void warn_of_isolated_vertices(const PolygonMesh& mesh, Defects& found);

}  // namespace fairing
