// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace fairing {

// Whether a level of n subdivisions and so many points is served by rows: where faces are small, passes over faces and
// edges cost more than an index a number; where they are large, rows cost more memory, and the time to read it.
constexpr bool has_rows(int n, std::size_t points) {
  return n > 1 && n <= 16 && points <= std::size_t(1) << 22;
}

}  // namespace fairing
