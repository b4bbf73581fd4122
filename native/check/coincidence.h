// SPDX-License-Identifier: GPL-3.0-or-later
// Which vertices lie at exactly the same point.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fairing {

// For every vertex the first vertex at the same coordinates (itself, most often). Linear time.
std::vector<std::int32_t> first_at_same_point(std::span<const double> coordinates);

}  // namespace fairing
