// SPDX-License-Identifier: GPL-3.0-or-later
// Straight sides between arcs, as outlines of rounded boxes have them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/types.h"

namespace fairing {

// Direction at `end` of an arc that turns evenly along a polyline's last two chords, of unit length; it
// goes on from there. All parallels to the polyline have the same one, as insets of an outline do.
Vec3 tangent_of_arc(const Vec3& first, const Vec3& middle, const Vec3& end);

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
