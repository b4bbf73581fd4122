// SPDX-License-Identifier: GPL-3.0-or-later
// Feature curves from one corner to the next, including corners that are not marked.
#pragma once

#include <span>
#include <vector>

#include "mesh/control_mesh.h"

namespace fairing {

// A chain or a part of one, with vertices and edges as in Chain.
struct Stretch {
  std::vector<Index> vertices, edges;
  bool closed;
};

std::vector<Stretch> stretches_of(const Chain& chain, std::span<const Vec3> positions);

}  // namespace fairing
