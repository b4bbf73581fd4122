// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/frame.h"

#include <cmath>

namespace fairing {

Frame frame_of(const ControlMesh& mesh) {
  Frame frame;
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.ring(v).empty()) continue;  // an isolated vertex far away is no reason to lose digits
    low = low.cwiseMin(mesh.positions[std::size_t(v)]);
    high = high.cwiseMax(mesh.positions[std::size_t(v)]);
  }
  const Vec3 centre = 0.5 * low + 0.5 * high;
  const double size = (high - low).maxCoeff();
  if (!centre.allFinite() || !(size > 0)) return frame;
  frame.centre = centre;
  frame.scale = std::exp2(std::floor(std::log2(size)));
  return frame;
}

}  // namespace fairing
