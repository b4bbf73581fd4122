// SPDX-License-Identifier: GPL-3.0-or-later
// What is nothing but rounding, relative to what it was computed from.
#pragma once

#include <limits>

namespace fairing {

// What some thousand operations in double precision leave where exact arithmetic leaves nothing.
// Lengths, areas and cosines that are smaller than this share of their like are zero.
constexpr double rounding = 4096 * std::numeric_limits<double>::epsilon();

// The same of numbers that come from coordinates in single precision, as files and Blender keep them.
constexpr double single_rounding = 8 * double(std::numeric_limits<float>::epsilon());

}  // namespace fairing
