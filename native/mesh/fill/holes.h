// SPDX-License-Identifier: GPL-3.0-or-later
// The holes of a mesh: closed walks along edges that have one face.
#pragma once

#include <cstdint>
#include <vector>

#include "base/error.h"
#include "mesh/half_edges.h"

namespace fairing {

// Vertex ids around a hole, which is on the left: a face that fills it has the same direction. No
// vertex occurs twice.
using HoleLoop = std::vector<std::int64_t>;

// Largest number of vertices of a filled hole with its islands, as in messages.
constexpr std::size_t longest_hole = 16'384;

std::string too_long_text(std::size_t vertices);

struct FoundHoles {
  // Each from its least vertex on, in ascending order of these.
  std::vector<HoleLoop> loops;
  // Why other border edges do not bound a hole: one error for those that share vertices, which are
  // its elements.
  std::vector<FairingError> unclear;
};

// A walk that touches itself in a vertex is cut there. Walks that meet an edge of more than two
// faces, or faces with different orientations, do not close: they are unclear. The border of a face
// that is a sheet alone is left out. The mesh must have passed require_arrays
// (mesh/validate/check.h).
FoundHoles find_holes(const PolygonMesh& mesh, const HalfEdges& half_edges);

}  // namespace fairing
