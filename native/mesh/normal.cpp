// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/normal.h"

#include <Eigen/Geometry>

namespace fairing {

Vec3 control_normal(const ControlMesh& mesh, Index v) {
  Vec3 normal = Vec3::Zero();
  for (const Spoke& spoke : mesh.ring(v)) {
    if (spoke.face < 0) continue;
    const Face& face = mesh.faces[spoke.face];
    const auto edge_to = [&](int corner) -> Vec3 {
      const Index w = face.vertex[(corner + face.size) % face.size];
      return mesh.positions[w] - mesh.positions[v];
    };
    normal += edge_to(spoke.corner + 1).cross(edge_to(spoke.corner - 1));
  }
  return normal;
}

}  // namespace fairing
