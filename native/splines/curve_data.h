// SPDX-License-Identifier: GPL-3.0-or-later
// The data of curve fits: points of the lattice, and normals from both sides of them.
#pragma once

#include "splines/curve_fit.h"
#include "splines/topology.h"

namespace fairing {

class CurveSource {
 public:
  // Lines of the lattice that turn by less than half of `normal_tolerance`, radians, from step to
  // step are straight.
  CurveSource(const Lattice& lattice, const Topology& topology, double normal_tolerance)
      : lattice_(lattice), topology_(topology), straight_(normal_tolerance / 2) {}

  // The data of a chain that is a crease or a boundary.
  CurveData sharp_chain(Index c) const;
  // The normal of the surface at the vertex of a sector. If creases bound the sector, their
  // `curves` lie in its plane. Zero if they cannot, at a kink of the surface.
  Vec3 sector_normal(Index sector, const std::vector<FittedCurve>& curves) const {
    return sector_normal(sector, &curves);
  }
  CurveData smooth_chain(Index c, const std::vector<Vec3>& sector_normals) const;
  // The data of the curve from the midpoint of side s of triangle f to its centroid.
  CurveData inner(Index f, int s, const std::vector<FittedCurve>& curves) const;

  // Number of steps between the points of a control edge.
  int samples() const;

  // The kinks of all sectors, from the lattice's own lines. Kinks of less than `least` radians do
  // not count.
  std::vector<Kink> kinks(double least) const;

 private:
  // Unit tangents of the creases that bound a sector, away from the vertex.
  std::vector<Vec3> crease_tangents(Index sector, const std::vector<FittedCurve>* curves) const;
  Vec3 sector_normal(Index sector, const std::vector<FittedCurve>* curves) const;
  Vec3 tangent_at(const EdgeChain& chain, int vertex) const;
  double narrowest_angle(Index e, bool at_end) const;
  std::vector<Vec3> edge_points(Index e) const;
  std::vector<Vec3> edge_normals(Index e, const std::vector<Vec3>& sector_normals) const;
  Vec3 edge_normal(const ControlEdge& edge, int k) const;
  Vec3 on_median(Index f, int s, double row) const;
  Vec3 centroid(Index f) const;
  Vec3 normal_inside(Index f, double i, double j, const Vec3& at) const;
  void add_crease_tangent(Index f, int s, bool at_end, const std::vector<FittedCurve>* curves,
                          std::vector<Vec3>& tangents) const;

  const Lattice& lattice_;
  const Topology& topology_;
  double straight_;
};

}  // namespace fairing
