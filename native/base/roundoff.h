// SPDX-License-Identifier: GPL-3.0-or-later
// Limits of rounding errors, relative to the numbers they come from.
#pragma once

#include <limits>

namespace fairing {

// Error of some thousand operations in double precision. Lengths, areas and cosines below this
// share of comparable ones count as zero.
constexpr double roundoff = 4096 * std::numeric_limits<double>::epsilon();

// The same for coordinates in single precision, as in files and Blender.
constexpr double single_roundoff = 8 * double(std::numeric_limits<float>::epsilon());

}  // namespace fairing
