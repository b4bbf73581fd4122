// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the arrays describe faces at all: sizes, offsets, finite numbers, valid and distinct indices.
#pragma once

#include "check/polygon_mesh.h"

namespace fairing {

// Throws FairingError: empty_mesh, no_faces, bad_shape, too_large, non_finite, index_out_of_range,
// repeated_vertex. What passes may be read without bounds checks and with 32-bit ids.
void check_arrays(const PolygonMesh& mesh);

}  // namespace fairing
