// SPDX-License-Identifier: GPL-3.0-or-later
// Straight sides between arcs, as outlines of rounded boxes have them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/types.h"

namespace fairing {

// Vertices to which other curves go from the two ends of an open chain.
struct Beyond {
  std::vector<Vec3> first, last;
};

// By segment of a chain: 1 if it belongs to a line that is tangent to the curve on its two sides, or
// on the only one. A line has one segment, or several in one direction; its neighbour is the arc of the
// next three vertices, of which one may lie beyond the chain's end.
std::vector<std::uint8_t> tangent_lines(std::span<const Vec3> vertices, bool closed,
                                        const Beyond& beyond = {});

}  // namespace fairing
