// SPDX-License-Identifier: GPL-3.0-or-later
// The one place that knows OpenMesh: faces in, edges, sides and one-rings out.
#pragma once

#include "control_mesh/control_mesh.h"

namespace fairing {

// Fills sides, edges and rings from `faces` (vertex, size, first_side) and `positions` (for their number).
void connect_faces(ControlMesh& control);

}  // namespace fairing
