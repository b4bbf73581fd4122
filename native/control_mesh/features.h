// SPDX-License-Identifier: GPL-3.0-or-later
// Where the surface is only continuous: creases and boundaries, their corners, and the chains between.
#pragma once

#include "control_mesh/control_mesh.h"

namespace fairing {

// Fills feature_edge, feature_vertex and chains of a mesh whose other tables are complete.
// `mesh` is the oriented input, for the normals of its polygons.
void find_features(const PolygonMesh& mesh, const FeatureOptions& options, ControlMesh& control);

}  // namespace fairing
