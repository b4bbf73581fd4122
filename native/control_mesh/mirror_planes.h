// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "control_mesh/control_mesh.h"

namespace fairing {

struct Plane {
  Vec3 normal;    // of length one
  double offset;  // of the plane's points along the normal

  Vec3 image(const Vec3& p) const { return p - 2 * (normal.dot(p) - offset) * normal; }
};

// All planes that may mirror the vertices, the coordinate planes first; most are none. Positions as find_mirrors takes
// them (control_mesh/mirror.h).
std::vector<Plane> mirror_planes(const ControlMesh& mesh, double tolerance);

}  // namespace fairing
