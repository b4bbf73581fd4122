// SPDX-License-Identifier: GPL-3.0-or-later
// The faired region: which control vertices, edges and faces are inside, on its joint, or outside.
#pragma once

#include "mesh/control_mesh.h"

namespace fairing {

// Says for each vertex, edge and face of a mesh with complete rings whether it is inside the
// region; a region of all faces is the whole mesh. Throws FairingError: index_out_of_range for
// faces that do not exist, bad_option for no faces at all.
void find_region(const RegionOptions& options, ControlMesh& control);

// Throws what find_region does for a region of a mesh of so many input faces.
void require_faces(const RegionOptions& options, std::int64_t faces);

// Marks the joint edges that carry a fit, and their ends; all but features do, unless the region
// joins in position only. Call it after find_features.
void mark_clamped_joint(ControlMesh& control);

}  // namespace fairing
