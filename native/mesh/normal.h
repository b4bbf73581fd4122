// SPDX-License-Identifier: GPL-3.0-or-later
// The normals that a control mesh has itself, before any surface.
#pragma once

#include "mesh/control_mesh.h"

namespace fairing {

// The sum over the faces around a vertex, by their areas there; not of unit length.
Vec3 control_normal(const ControlMesh& mesh, Index v);

}  // namespace fairing
