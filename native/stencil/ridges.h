// SPDX-License-Identifier: GPL-3.0-or-later
// Ridges: strips of quads much longer than the radius by which the mesh turns across them.
#pragma once

#include <array>
#include <vector>

#include "mesh/control_mesh.h"

namespace fairing {

// By which lengths raised to the exponent are to be multiplied in the control metric: of each face
// along its sides 0 and 2, and along its sides 1 and 3. 1 off ridges, of triangles, and for the
// exponents 0 and 1.
//
// Between the ends of long quads nothing holds what they turn about. The surface of least energy
// through rings of a tube with the radius r, l apart, is hollow half way between them by
// (l / r)^4 / 384 of r where l is small, by 3 % for l = 2 r, and by all of r where it is long. So along
// a strip of quads that is such a tube none counts as longer than the radius. A tube runs from border to
// border, from crease to crease or into itself, and all along it the mesh turns by less from quad to
// quad than across it: the sides and bevels of boxes are none. A strip is shortened as a whole, for
// where lengths jump the surface waves; so those beside it follow, each by up to a quarter less.
std::vector<std::array<double, 2>> ridge_shares(const ControlMesh& mesh, double exponent);

}  // namespace fairing
