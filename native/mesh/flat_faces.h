// SPDX-License-Identifier: GPL-3.0-or-later
// Marks the elements of a control mesh that belong to flat faces.
#pragma once

#include <span>

#include "mesh/control_mesh.h"

namespace fairing {

// Fills `flat` of a mesh with complete rings. Throws FairingError(index_out_of_range) for missing
// faces.
void mark_flat_faces(std::span<const std::int64_t> faces, ControlMesh& control);

// A flag for each face that lies in one plane with all faces around its corners, so that the limit
// surface of subdivision is flat there.
std::vector<std::uint8_t> faces_amid_flats(const ControlMesh& control);

}  // namespace fairing
