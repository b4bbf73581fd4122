// SPDX-License-Identifier: GPL-3.0-or-later
// Feature curves: creases and boundaries, where the surface is only continuous; their corners; and
// the chains between. And where the surface turns softly.
#pragma once

#include "mesh/control_mesh.h"

namespace fairing {

// Fills feature_edge, feature_vertex, chains and soft of a mesh whose other tables are complete. `mesh`
// is the oriented input, for the normals of its polygons. Throws FairingError: bad_feature_edge for
// creases and boundary edges that are not edges, index_out_of_range for missing vertices.
void find_features(const PolygonMesh& mesh, const FeatureOptions& options, ControlMesh& control);

}  // namespace fairing
