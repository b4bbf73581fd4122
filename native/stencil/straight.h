// SPDX-License-Identifier: GPL-3.0-or-later
// Faces that stay straight in one direction, as those around a cylinder (mesh/flat_faces.h): the
// second difference in that direction counts as much as on flat faces.
#pragma once

#include "grid/runs.h"
#include "stencil/chart.h"
#include "stencil/fit.h"

namespace fairing {

// Multiplies the second difference of an element's fit in the direction in which its faces are
// straight; of none if not all of them are flat. An edge between two of them is straight itself.
void stiffen_straight(const ControlMesh& mesh, const Element& element, const Chart& chart,
                      FitRows& rows);

}  // namespace fairing
