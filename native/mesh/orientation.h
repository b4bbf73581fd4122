// SPDX-License-Identifier: GPL-3.0-or-later
// The orientation of the faces of each sheet, and which sheets have only one side.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/half_edges.h"

namespace fairing {

struct Orientation {
  // Faces (ascending) to flip so that all neighbours agree: in each component the minority; of two
  // halves, the one without the component's first face.
  std::vector<std::int64_t> to_flip;
  std::vector<std::int64_t> one_sided;  // all faces (ascending) of non-orientable components
};

Orientation find_orientation(const PolygonMesh& mesh, const HalfEdges& half_edges);

// The mesh with these faces reversed; their first corners stay first.
OwnedPolygonMesh with_flipped(const PolygonMesh& mesh, std::span<const std::int64_t> faces);

}  // namespace fairing
