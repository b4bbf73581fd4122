// SPDX-License-Identifier: GPL-3.0-or-later
// Distinguishes scatter from the strain of exact shapes by quartics through the vertices around. A
// discretization strains an exact surface by its curvature, and where stars differ, as in triangles
// with alternating diagonals, these loads alternate as those of scatter do.
#pragma once

#include <span>
#include <vector>

#include "mesh/control_mesh.h"
#include "strain/ease_system.h"

namespace fairing {

struct Scatter {
  // Largest standard deviation along the normals that the distances from the quartics allow, by
  // their median: all vertices scatter, but few vertices of a shape are far from quartics, such as
  // those on narrow hills. Infinite if each quartic passes through its vertex.
  double most;
  // The loads of the same surface if all stars were alike: those of the distances from the quartics,
  // and of the remaining loads means over the vertices around.
  Columns loads;
};

// Of `vertices` inside surfaces. `root`: square roots of their shares of area; `system`: theirs,
// scaled by the roots.
Scatter scatter_of(const ControlMesh& mesh, std::span<const Vec3> positions,
                   const std::vector<Index>& vertices, const std::vector<double>& root,
                   const EaseSystem& system);

}  // namespace fairing
