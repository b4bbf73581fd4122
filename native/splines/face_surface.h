// SPDX-License-Identifier: GPL-3.0-or-later
// The refined surface between the lattice's points, which patches are measured against.
#pragma once

#include <array>

#include "splines/topology.h"

namespace fairing {

// Over one control face. What bends one way in a cell lies between the flat cell and the planes that
// touch it at the cell's corners; what lies there is not off.
class FaceSurface {
 public:
  FaceSurface(const Lattice& lattice, const Topology& topology, Index f)
      : lattice_(lattice), topology_(topology), face_(f) {}

  // How far a patch's point at (u, v) is off, along the normal. The patch is all of the face, or its
  // third at a corner (PatchPlace). Beyond the face's sides the surface is continued.
  double height(const Vec3& point, int corner, double u, double v) const;

 private:
  // Its corners, as many as the face has, and what each counts at the foot.
  struct Foot {
    std::array<GridPoint, 4> corner{};
    std::array<double, 4> share{};
    double i, j;
  };

  Vec3 at(int i, int j) const { return lattice_.position(face_, {i, j}); }
  Foot foot_in_quad(const Vec3& point, double i, double j) const;
  Foot foot_in_triangle(const Vec3& point, double i, double j) const;
  bool slope(GridPoint p, int di, int dj, Vec3& out) const;
  Vec3 normal_at(GridPoint p) const;  // zero in tips

  const Lattice& lattice_;
  const Topology& topology_;
  Index face_;
};

}  // namespace fairing
