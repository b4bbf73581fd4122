// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace fairing {

// An edge by its vertices.
using VertexPair = std::array<std::int64_t, 2>;

inline VertexPair ascending(std::int64_t a, std::int64_t b) {
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace fairing
