// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "check/polygon_mesh.h"
#include "fair/options.h"

namespace fairing {

// Throws FairingError(bad_option), naming the option and its range.
void check_options(const PolygonMesh& mesh, const FairOptions& options);

}  // namespace fairing
