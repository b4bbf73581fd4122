// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fairing/fixed_normals.h"

namespace fairing {

// Up to this angle a normal shows which side of a surface is up; a fixed normal farther from the
// faces around is refused. If the control mesh turns by more, the surface may turn by over 90
// degrees: a cube's does by 96 around its vertices, on point forces.
constexpr double steepest = 80 * degree;

}  // namespace fairing
