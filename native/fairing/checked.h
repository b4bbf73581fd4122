// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of a mesh before anything is built on it.
#pragma once

#include "fairing/options.h"
#include "fairing/report.h"
#include "mesh/control_mesh.h"

namespace fairing {

// Writes warnings and the faces to reverse into `report`. Throws FairingError for defects, and for
// a mesh that the energy does not accept.
void check_mesh(const PolygonMesh& input, const FairOptions& options, Report& report);

SheetReport sheets_of(const ControlMesh& mesh);

}  // namespace fairing
