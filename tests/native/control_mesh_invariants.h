// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/control_mesh.h"

namespace fairing::test {

// Expects (through GoogleTest) that all tables of a control mesh agree with each other.
void expect_consistent(const ControlMesh& mesh);

}  // namespace fairing::test
