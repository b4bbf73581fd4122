// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines of flat parts that are taken out of the region.
#pragma once

#include <span>

#include "mesh/control_mesh.h"

namespace fairing {

// Adds the outlines of the flagged faces to the chains, as curves in their planes: so the cap of a can is a disc. At
// most one fold leaves a smooth outline at each vertex, and it turns by 60 degrees at most; at others it has a
// corner, as where two rims of a box meet.
void add_flat_outlines(std::span<const std::uint8_t> flat, ControlMesh& control);

}  // namespace fairing
