// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh/control_mesh.h"

namespace fairing::test {

// Modified butterfly subdivision (Zorin, Schröder, Sweldens 1996) of a closed triangle mesh: the
// points of lattice level `levels`, 3 numbers each, to compare with. Slow: it walks around explicit
// cells.
std::vector<double> butterfly(const ControlMesh& mesh, int levels);

}  // namespace fairing::test
