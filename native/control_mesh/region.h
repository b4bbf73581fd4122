// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "control_mesh/control_mesh.h"

namespace fairing {

// Fills the places of a mesh whose faces, edges and rings are complete; a region of all faces is none.
// Throws FairingError: index_out_of_range (faces), bad_option for no faces at all.
void find_region(const RegionOptions& options, ControlMesh& control);

// Where the joint is more than a line. Needs the features.
void mark_clamped_joint(ControlMesh& control);

}  // namespace fairing
