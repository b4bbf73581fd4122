// SPDX-License-Identifier: GPL-3.0-or-later
// Normals of the control mesh itself.
#pragma once

#include "mesh/control_mesh.h"

namespace fairing {

// The area-weighted sum over the faces around a vertex; not of unit length.
Vec3 control_normal(const ControlMesh& mesh, Index v);

}  // namespace fairing
