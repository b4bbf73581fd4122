// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "execution/memory.h"
#include "execution/workers.h"
#include "lattice/lattice.h"

namespace fairing {

struct OutputFaces {
  Array<std::int32_t> triangles, quads;                // 3 and 4 a face
  Array<std::int32_t> triangle_polygon, quad_polygon;  // the input face that each comes from
};

// The cells of every control face's lattice, in the control faces' order, row by row, counter-clockwise.
OutputFaces make_faces(const Lattice& lattice, Workers& workers);

}  // namespace fairing
