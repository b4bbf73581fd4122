// SPDX-License-Identifier: GPL-3.0-or-later
// How large a run will be, before anything is allocated. The bytes are estimated from what each
// kind of array takes, counted from its elements, mostly a little above; the tests hold them against
// the ledger
// (tests/python/test_memory.py).
#pragma once

#include <cstddef>
#include <cstdint>

#include "fairing/options.h"
#include "grid/accumulate.h"
#include "mesh/control_mesh.h"

namespace fairing {

struct RunSize {
  std::int64_t points = 0;
  std::int64_t solved = 0;     // the same with sheets apart, as the solve has them
  std::int64_t triangles = 0;  // the whole surface as triangles
  std::int64_t bytes = 0;      // peak of the run's own arrays
};

// `tense`: under tension, which takes a little more.
//
// From the number of vertices, up to 2^31, and from faces that require_faces() lets pass. Polygons
// count as if split around a centre, quads that will be split count as quads. Sizes beyond any
// machine are the largest number of bytes.
RunSize predict_size(std::int64_t vertices, std::span<const std::int64_t> corners,
                     std::span<const std::int64_t> offsets, int levels, std::size_t shapes = 0,
                     Energy energy = Energy::thin_plate, bool tense = false);
// From the mesh as it is after splits: exact counts.
RunSize predict_size(const ControlMesh& mesh, const Unknowns& unknowns, int levels,
                     std::size_t shapes = 0, Energy energy = Energy::thin_plate, bool tense = false,
                     bool back_leg = false);

// Throws FairingError(too_large), naming the figures, when the run does not fit into
// options.memory_limit or its ids into 32 bits. The first takes next to no time, and lets pass what
// only the exact counts can tell.
void require_fit(const PolygonMesh& mesh, const FairOptions& options);
void require_fit(const RunSize& size, const FairOptions& options);

}  // namespace fairing
