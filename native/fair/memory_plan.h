// SPDX-License-Identifier: GPL-3.0-or-later
// How large a run will be, before anything is allocated.
#pragma once

#include <cstddef>
#include <cstdint>

#include "control_mesh/control_mesh.h"
#include "fair/options.h"

namespace fairing {

struct RunSize {
  std::int64_t points = 0;
  std::int64_t triangles = 0;  // the whole surface as triangles
  std::int64_t bytes = 0;      // peak of the run's own arrays
};

// From the plain arrays alone, checked or not (polygons count as if split around a centre; quads that will be split
// count as quads).
RunSize predict_size(const PolygonMesh& mesh, int levels, std::size_t shapes = 0,
                     Energy energy = Energy::thin_plate);
// Exact counts.
RunSize predict_size(const ControlMesh& mesh, int levels, std::size_t shapes = 0,
                     Energy energy = Energy::thin_plate);

// Throws FairingError(too_large) with the figures when the run does not fit in the limit or in 32-bit ids; the first
// costs nothing, and lets pass what only an exact count can tell.
void require_fit(const PolygonMesh& mesh, const FairOptions& options);
void require_fit(const RunSize& size, const FairOptions& options);

}  // namespace fairing
