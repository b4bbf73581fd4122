// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fairing {

// The cosine of 60 degrees: neighbouring triangles that turn by more make a fold rather than a
// curved surface.
constexpr double sharp_turn = 0.5;

}  // namespace fairing
