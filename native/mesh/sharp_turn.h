// SPDX-License-Identifier: GPL-3.0-or-later
// Where a mesh is folded rather than curved.
#pragma once

namespace fairing {

// The cosine of 60 degrees: neighbouring triangles that turn by more make a fold.
constexpr double sharp_turn = 0.5;

}  // namespace fairing
