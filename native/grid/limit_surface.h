// SPDX-License-Identifier: GPL-3.0-or-later
// The Catmull-Clark limit surface of the input's polygons at the points of a grid, and how strongly a plate
// is to be drawn to it.
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
  // How many steps of subdivision the finest grid of a control mesh takes.
  static int steps(const ControlMesh& control, int levels);

  // `subdivision`: of the input, by so many steps.
  explicit LimitSurface(std::shared_ptr<const CatmullClark> subdivision)
      : subdivision_(std::move(subdivision)) {}

  // 3 numbers a point of the finest grid. `cage`: those of the input's vertices. Control vertices are
  // where they are `held`. So are, on flat faces between them, the polygons that were cut otherwise
  // than around their centre, but for quads: they have no such place for a point.
  Array<double> at_points(const GridLevel& grid, std::span<const double> cage,
                          std::span<const Vec3> held, Workers& workers) const;

 private:
  class FaceMap;
  std::shared_ptr<const CatmullClark> subdivision_;
};

// How a plate is to be held on a surface so that it does not wave where faces are thin. At a point whose
// area is S at unit grid spacing, distances d from the surface weigh as much as its own bending times
// (d / r)^2 (S / r^2)^2: the more the longer faces are than r, and the more they turn. With r the
// shortest control edge at the control vertices near the point: their geometric mean, smoothly from
// vertex to vertex. One number a point, the fourth root of 1 / r^6. It falls to nothing where a region
// meets what is outside.
Array<float> hold_of_thin_faces(const GridLevel& grid, std::span<const Vec3> control,
                                Workers& workers);

}  // namespace fairing
