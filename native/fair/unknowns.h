// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fair/options.h"
#include "lattice/accumulate.h"

namespace fairing {

// Everything that moves: inside the region, control vertices that are free or weighted, and points off the curves.
Unknowns choose_unknowns(const ControlMesh& mesh, const FairOptions& options);

}  // namespace fairing
