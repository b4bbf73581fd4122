// SPDX-License-Identifier: GPL-3.0-or-later
// Faces that stay straight in one direction, as those around a cylinder (mesh/flat_faces.h): the
// second difference in that direction counts as much as on flat faces. The file also weights the
// edges between such faces and soft ones.
#pragma once

#include <array>
#include <span>

#include "grid/runs.h"
#include "stencil/chart.h"

namespace fairing {

// Multiplies the second difference in the direction in which an element's faces are straight; none
// if not all of them are flat. An edge between two of them is straight itself. Across an edge where
// the stiffness jumps, the second difference is multiplied by the harmonic mean of both: else the
// edge would be a hinge as wide as the stiff face's cells. `hessians`: the last three of fit()'s
// coefficients (stencil/fit.h), one set a neighbour.
void stiffen_straight(const ControlMesh& mesh, const Element& element, const Chart& chart,
                      std::span<std::array<double, 3>> hessians);

}  // namespace fairing
