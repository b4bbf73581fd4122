// SPDX-License-Identifier: GPL-3.0-or-later
// Ridges: strips of quads much longer than the radius by which the mesh turns across them.
#pragma once

#include <array>
#include <vector>

#include "mesh/control_mesh.h"

namespace fairing {

// Factors of lengths raised to the exponent in the control metric: for each face along its sides 0
// and 2, and along its sides 1 and 3. 1 off ridges, for triangles, and for the exponents 0 and 1.
//
// Between the ends of long quads no vertex holds the curvature across them. The surface of least
// energy through rings of a tube with the radius r, l apart, is hollow half way between them by (l
// / r)^4 / 384 of r where l is small, by 3 % for l = 2 r, and by all of r where l is large. So
// along a strip of quads that is such a tube no quad counts as longer than the radius. A tube runs
// from border to border, from crease to crease or into itself, and all along it the mesh turns by
// less from quad to quad than across it; the sides and bevels of boxes do not qualify. A strip is
// shortened as a whole, because the surface waves where lengths jump; so the strips beside it
// follow, each by up to a quarter less.
std::vector<std::array<double, 2>> ridge_shares(const ControlMesh& mesh, double exponent);

}  // namespace fairing
