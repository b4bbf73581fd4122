// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the arrays describe faces at all: sizes, offsets, finite numbers, valid and distinct indices.
#pragma once

#include "check/defect.h"
#include "check/polygon_mesh.h"

namespace fairing {

// What the later tests may rely on.
struct Readable {
  bool faces = false;        // ids in range, three corners or more: no bounds checks needed, 32-bit ids do
  bool simple = false;       // moreover no face names a vertex twice
  bool coordinates = false;  // all finite
};

// Adds empty_mesh, no_faces, bad_shape, too_large, non_finite, index_out_of_range, repeated_vertex.
Readable check_arrays(const PolygonMesh& mesh, Defects& found);

// Vertices with a coordinate that is NaN, infinite or beyond 1e100.
std::vector<std::int64_t> non_finite_vertices(std::span<const double> coordinates);

}  // namespace fairing
