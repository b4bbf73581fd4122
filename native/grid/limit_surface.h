// SPDX-License-Identifier: GPL-3.0-or-later
// The Catmull-Clark limit surface of the input's polygons at the points of a grid, and the penalty
// on a plate's distance from it.
#pragma once

#include <memory>
#include <span>
#include <utility>

#include "grid/grid_level.h"
#include "mesh/catmull_clark.h"
#include "parallel/workers.h"

namespace fairing {

class LimitSurface {
 public:
  // Number of subdivision steps for the finest grid of a control mesh.
  static int steps(const ControlMesh& control, int levels);

  // `subdivision`: of the input, with so many steps.
  explicit LimitSurface(std::shared_ptr<const CatmullClark> subdivision)
      : subdivision_(std::move(subdivision)) {}

  // 3 numbers a point of the finest grid. `cage`: the input's vertices. Control vertices are at
  // their `held` positions. Polygons that were cut otherwise than around their centre, except
  // quads, are flat faces between these, because they have no corresponding points.
  Array<double> at_points(const GridLevel& grid, std::span<const double> cage,
                          std::span<const Vec3> held, Workers& workers) const;

 private:
  class FaceMap;
  std::shared_ptr<const CatmullClark> subdivision_;
};

// Weight of the penalty, so that the plate does not oscillate where faces are thin. At a point with
// the area S at unit grid spacing, a distance d from the surface has the weight of its own bending
// times (d / r)^2 (S / r^2)^2: it grows with the length of faces over r, and with their turn. r is
// the shortest control edge at the control vertices near the point: their geometric mean, smoothly
// from vertex to vertex. One number a point, the fourth root of 1 / r^6. It fades to zero at the
// rim of a region.
Array<float> thin_face_penalty(const GridLevel& grid, std::span<const Vec3> control,
                               Workers& workers);

}  // namespace fairing
