// SPDX-License-Identifier: GPL-3.0-or-later
// Straight sides between arcs, as outlines of rounded boxes have them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/types.h"

namespace fairing {

// Direction at `end` of the circle through three points, not normalized; along their line if they have
// one. It goes from `first` to `end`.
Vec3 tangent_of_circle(const Vec3& first, const Vec3& middle, const Vec3& end);

// By segment of a chain: 1 if it belongs to a line that is tangent to the curve on its two sides, or
// on the only one. A line has one segment, or several in one direction; its neighbour has the tangent
// of the circle through its last three vertices.
std::vector<std::uint8_t> tangent_lines(std::span<const Vec3> vertices, bool closed);

}  // namespace fairing
