// SPDX-License-Identifier: GPL-3.0-or-later
// The Catmull-Clark limit surface of the input's polygons at the points of a grid, and the penalty
// on a plate's distance from it.
#pragma once

#include <memory>
#include <span>
#include <utility>

#include "grid/grid_level.h"
#include "mesh/catmull_clark.h"
#include "mesh/flat_faces.h"
#include "parallel/workers.h"

namespace fairing {

// Weight of the penalty where the limit surface is flat, in stiffnesses of the faired surface at the
// point. Measured on a phone case at level 3: without it the plate's flats turn by 1.2 degrees, with 10
// by 0.05, with 100 by 0.006; with 1,000 pads beside the flats do not settle.
constexpr double flat_penalty = 100;

class LimitSurface {
 public:
  // Number of subdivision steps for the finest grid of a control mesh.
  static int steps(const ControlMesh& control, int levels);

  // `subdivision`: of the input, with so many steps.
  // `cage`: the control mesh, at the input's positions.
  LimitSurface(std::shared_ptr<const CatmullClark> subdivision, const ControlMesh& cage)
      : subdivision_(std::move(subdivision)), flatness_(flatness(cage)) {}

  // 3 numbers a point of the finest grid. `cage`: the input's vertices. Control vertices are at
  // their `held` positions. Polygons that were cut otherwise than around their centre, except
  // quads, are flat faces between these, because they have no corresponding points.
  Array<double> at_points(const GridLevel& grid, std::span<const double> cage,
                          std::span<const Vec3> held, Workers& workers) const;

  // Weight of the penalty, so that the plate does not oscillate where faces are thin. At a point
  // with the area S at unit grid spacing, a distance d from the surface has the weight of its own
  // bending times (d / r)^2 (S / r^2)^2: it grows with the length of faces over r, and with their
  // turn. r is the shortest control edge at the control vertices near the point: their geometric
  // mean, smoothly from vertex to vertex. One number a point, the fourth root of 1 / r^6; infinite
  // where this surface is flat, and in faces between there and a rim. It fades to zero at the rim of
  // a region.
  Array<float> penalty(const GridLevel& grid, std::span<const Vec3> control,
                       Workers& workers) const;

 private:
  class FaceMap;
  std::shared_ptr<const CatmullClark> subdivision_;
  std::vector<Flatness> flatness_;  // of control faces
};

}  // namespace fairing
