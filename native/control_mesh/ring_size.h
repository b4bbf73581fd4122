// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "control_mesh/control_mesh.h"

namespace fairing {

// Points of the ring about a control vertex on any level: one a spoke, and one across each quad.
inline Index ring_size(const ControlMesh& mesh, Index v) {
  Index size = 0;
  for (const Spoke& spoke : mesh.ring(v))
    size += spoke.face >= 0 && mesh.faces[std::size_t(spoke.face)].quad() ? 2 : 1;
  return size;
}

}  // namespace fairing
