// SPDX-License-Identifier: GPL-3.0-or-later
// The size of a run before anything is allocated: points and triangles exactly; bytes as an upper
// bound per point and level, up to twice the peak (tests/python/test_memory.py).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "fairing/options.h"

namespace fairing {

struct RunSize {
  std::int64_t points = 0;
  std::int64_t solved = 0;     // likewise with sheets apart, as the solve has them
  std::int64_t triangles = 0;  // the whole surface as triangles
  std::int64_t bytes = 0;      // peak of the run's own arrays; saturates at the largest number
};

// From the number of vertices, up to 2^31, and faces that pass require_faces(): polygons as if
// split around a centre, quads that will be split as quads, all inside the region. `options`
// provides levels, energy and all that takes memory.
RunSize predict_size(std::int64_t vertices, std::span<const std::int64_t> corners,
                     std::span<const std::int64_t> offsets, std::size_t shapes,
                     const FairOptions& options);

// Throws FairingError(too_large), naming the figures, when the run does not fit into
// options.memory_limit or its ids into 32 bits.
void require_fit(const RunSize& size, const FairOptions& options);

}  // namespace fairing
