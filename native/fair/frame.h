// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "control_mesh/control_mesh.h"

namespace fairing {

// Working coordinates: the mesh around the origin, of size one. The scale is a power of two, so it costs no digit, and
// single precision meets no tiny or huge unit.
struct Frame {
  Vec3 centre = Vec3::Zero();
  double scale = 1;  // world = centre + scale * working

  Vec3 to_working(const Vec3& world) const { return (world - centre) / scale; }
  Vec3 to_world(const Vec3& working) const { return centre + scale * working; }
};

Frame frame_of(const ControlMesh& mesh);

}  // namespace fairing
