// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the faces have an extent, and which vertices share a point.
#pragma once

#include "check/error.h"
#include "check/polygon_mesh.h"

namespace fairing {

// Throws FairingError coincident_vertices if vertices of one face lie at one point; vertices that share a
// point but no face (seams) are only worth a warning.
void check_coincident_vertices(const PolygonMesh& mesh, std::vector<Warning>& warnings);

// Throws FairingError degenerate_face: area below 1e-12 of the longest side squared.
void check_areas(const PolygonMesh& mesh);

void warn_of_isolated_vertices(const PolygonMesh& mesh, std::vector<Warning>& warnings);

}  // namespace fairing
