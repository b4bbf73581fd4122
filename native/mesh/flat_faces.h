// SPDX-License-Identifier: GPL-3.0-or-later
// Which elements of a control mesh belong to faces that are meant flat.
#pragma once

#include <span>

#include "mesh/control_mesh.h"

namespace fairing {

// Fills `flat` of a mesh with complete rings. Throws FairingError(index_out_of_range) for faces that do
// not exist.
void mark_flat_faces(std::span<const std::int64_t> faces, ControlMesh& control);

}  // namespace fairing
