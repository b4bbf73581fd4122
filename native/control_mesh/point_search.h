// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "control_mesh/control_mesh.h"

namespace fairing {

// Finds the vertex at a place: those that have faces, sorted along a direction that no mesh is aligned with.
class PointSearch {
 public:
  explicit PointSearch(const ControlMesh& mesh);

  static constexpr Index none = -1, several = -2;

  // The one vertex within `tolerance` of p.
  Index at(const Vec3& p, double tolerance) const;

 private:
  struct Entry {
    double key;
    Index vertex;
  };
  const std::vector<Vec3>& positions_;
  std::vector<Entry> entries_;
};

}  // namespace fairing
