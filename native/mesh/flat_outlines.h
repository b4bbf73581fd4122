// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines of flat parts that are taken out of the region.
#pragma once

#include <span>

#include "mesh/control_mesh.h"

namespace fairing {

// Adds the outlines of the flagged faces to the chains, as curves in their planes: the cap of a can
// becomes a disc. An outline is smooth at a vertex if at most one fold leaves it there and it turns
// by at most 60 degrees; otherwise it has a corner, as where two rims of a box meet.
void add_flat_outlines(std::span<const std::uint8_t> flat, ControlMesh& control);

}  // namespace fairing
