// SPDX-License-Identifier: GPL-3.0-or-later
// The faired region: which control vertices, edges and faces are inside, on its joint, or outside.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mesh/control_mesh.h"

namespace fairing {

// Classifies each vertex, edge and face of a mesh with complete rings; a region of all faces is the
// whole mesh. Throws FairingError: index_out_of_range for missing faces, bad_option for no faces.
void find_region(const RegionOptions& options, ControlMesh& control);

// Takes the flagged faces out of the region.
void put_outside(std::span<const std::uint8_t> faces, ControlMesh& control);

// One flag for each of `count` input faces; throws as find_region(). Also for other settings that
// name faces.
std::vector<std::uint8_t> chosen_faces(const RegionOptions& options, std::int64_t count);
std::vector<std::uint8_t> flags_of_faces(std::span<const std::int64_t> faces, std::int64_t count,
                                         const std::string& where);

// Marks the joint edges with divided differences, and their ends: all but features, unless the
// region joins in position only. Call it after find_features.
void mark_clamped_joint(ControlMesh& control);

}  // namespace fairing
