// SPDX-License-Identifier: GPL-3.0-or-later
// The refined surface between the points of the lattice, with which patches are compared.
#pragma once

#include <array>

#include "splines/topology.h"

namespace fairing {

// The surface over the control faces of a patch. A cell that bends in one direction lies between
// the flat cell and its tangent planes at the corners; a patch between these has no error.
class FaceSurface {
 public:
  FaceSurface(const Sheet& sheet, const Topology& topology) : sheet_(sheet), topology_(topology) {}

  struct Off {
    double by;
    int place;  // the face of the grid that contains the foot
  };
  // Distance of a patch's point at (u, v) along the normal; 0 if it is at most that face's entry of
  // `least`. The patch covers all faces, or a third at a corner (PatchPlace). The surface is
  // continued beyond the sides.
  Off height(const Vec3& point, int corner, double u, double v,
             std::span<const double> least) const;

 private:
  // The corners of the face's cell, and their weights at the foot.
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
