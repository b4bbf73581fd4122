// SPDX-License-Identifier: GPL-3.0-or-later
// What can be said of a mesh before anything is built on it.
#pragma once

#include "fairing/options.h"
#include "fairing/report.h"
#include "mesh/control_mesh.h"

namespace fairing {

// Warnings, and the faces to reverse, into `report`. Throws FairingError for what is wrong, or wrong
// for the energy.
void check_mesh(const PolygonMesh& input, const FairOptions& options, Report& report);

SheetReport sheets_of(const ControlMesh& mesh);

}  // namespace fairing
