// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the faces have an extent, and which vertices share a point.
#pragma once

#include "check/defect.h"
#include "check/polygon_mesh.h"

namespace fairing {

// Adds coincident_vertices: an error for vertices of one face that lie at one point; for all vertices that share a
// point without such a face (seams) a warning.
void check_coincident_vertices(const PolygonMesh& mesh, Defects& found);

// Adds degenerate_face: area below 1e-12 of the longest side squared.
void check_areas(const PolygonMesh& mesh, Defects& found);

// Adds isolated_vertices, a warning.
void warn_of_isolated_vertices(const PolygonMesh& mesh, Defects& found);

}  // namespace fairing
