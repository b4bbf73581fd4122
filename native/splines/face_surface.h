// SPDX-License-Identifier: GPL-3.0-or-later
// The refined surface between the lattice's points, which patches are measured against.
#pragma once

#include <array>

#include "splines/topology.h"

namespace fairing {

// Over a patch's control faces. What bends one way in a cell lies between the flat cell and the planes that
// touch it at the cell's corners; what lies there is not off.
class FaceSurface {
 public:
  FaceSurface(const Sheet& sheet, const Topology& topology) : sheet_(sheet), topology_(topology) {}

  struct Off {
    double by;
    int place;  // of the grid's faces, where the foot is
  };
  // How far a patch's point at (u, v) is off, along the normal; 0 where that is no more than `least`
  // says of the face. The patch is all of the faces, or a third at a corner (PatchPlace). Beyond
  // their sides the surface is continued.
  Off height(const Vec3& point, int corner, double u, double v,
             std::span<const double> least) const;

 private:
  // Its corners, as many as the face has, and what each counts at the foot.
  struct Foot {
    std::array<GridPoint, 4> corner{};
    std::array<double, 4> share{};
    double i, j;
  };

  Vec3 at(int i, int j) const { return sheet_.position({i, j}); }
  Foot foot_in_quad(const Vec3& point, double i, double j) const;
  Foot foot_in_triangle(const Vec3& point, double i, double j) const;
  bool slope(GridPoint p, int di, int dj, Vec3& out) const;
  Vec3 normal_at(GridPoint p) const;  // zero in tips

  Sheet sheet_;
  const Topology& topology_;
};

}  // namespace fairing
