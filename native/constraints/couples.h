// SPDX-License-Identifier: GPL-3.0-or-later
// Fixed normals. A fixed normal n at a control vertex c is two conditions on the divided
// differences there, n . x_u = n . x_v = 0, with (u, v) the vertex' chart. Their multipliers are
// couples, forces along n that turn the surface and do not push it. The slope of a couple at a
// point grows with every level, so it would hold nothing. So couples are spread, as loads are
// (pads.h),
//
//   K x = … + Omega sum_c n_c psi_c . m_c,   psi_c = (u, v) phi_c,
//
// with phi_c the hat of half the faces around the vertex. Over whole faces couples would do nearly
// what loads do. Half hats of two vertices do not overlap.
//
// At a vertex of a border curve, which nothing here moves, the curve fixes one tangent. Then v runs
// across the border and psi_c = (0, v) phi_c; x_u and x_v come from parabolas along the spokes, as a
// half ring determines no quadratic; and n means the nearest normal at a right angle to x_u.
#pragma once

#include <vector>

#include "constraints/pads.h"

namespace fairing {

struct FixedNormal {
  Index vertex;  // inside the region, and off all curves or on a smooth border
  Vec3 normal;   // of length one
};

// The m_c, one per normal, in the unit of loads: (u, v) are shares of the mean radius of the
// vertex' ring.
using Moments = LoadsOf<2>;
// Couples in space, with columns m_u and m_v; slopes x_u and x_v likewise.
using Couple = Eigen::Matrix<double, 3, 2>;

// The part of couples that is common to all levels.
class Couples {
 public:
  // First level on which half a hat has points; below it whole hats are used.
  static constexpr int first_level = 2;

  // Positions of `mesh` in working coordinates.
  Couples(const ControlMesh& mesh, const ChartMaker& charts, std::vector<FixedNormal> normals,
          Workers& workers);

  std::size_t size() const { return normals_.size(); }
  const Vec3& normal(std::size_t c) const { return normals_[c].normal; }

  // Sets of normals so far apart that their couples hardly affect each other.
  std::vector<std::vector<std::size_t>> sets_apart() const;

 private:
  friend class LevelCouples;
  // One spoke of a vertex' ring, in (u, v): its end, the far corner of the face behind it, and that
  // face's other neighbour of the vertex; and the weights of points on it and inside the face.
  struct Arm {
    Vec2 ahead, far, behind;
    double edge_weight, face_weight;
  };

  bool on_border(std::size_t c) const { return !mesh_.vertex_fit(normals_[c].vertex); }
  void fill_border_rows(std::size_t c, Chart& chart);
  void fill_arms(std::size_t c, const Chart& chart, const std::vector<FlatFace>& flat);

  const ControlMesh& mesh_;
  Workers& workers_;
  std::vector<FixedNormal> normals_;
  std::vector<std::size_t> first_arm_, first_row_;  // per normal, and the end
  Array<Arm> arms_;
  // Of the first divided differences, one per neighbour; on borders of slopes, one per spoke.
  Array<Vec2> rows_;
};

// The slopes of a unit couple, one matrix per normal, and sum Omega psi_c . (u, v) on the level
// where they were measured. Other levels have nearly the same.
struct Compliance {
  std::vector<Eigen::Matrix2d> slopes;
  std::vector<double> totals;
};

// Couples with hats sampled on a level's points; edges have at least two pieces.
class LevelCouples {
 public:
  // Both must outlive it.
  LevelCouples(const Couples& couples, const GridLevel& grid);

  const GridLevel& grid() const { return grid_; }
  std::size_t size() const { return couples_.size(); }

  // r <- r + Omega sum_c n_c psi_c . m_c, 3 numbers a point.
  void add(const Moments& moments, double* r) const;
  // The same for couples in any direction.
  void add(const std::vector<Couple>& couples, double* r) const;
  // The slopes of x at the vertex, by its divided differences.
  Couple slopes(std::size_t c, const double* x) const;
  // Angle between the fixed normal and that of x; radians, from 0 to pi.
  double angle(std::size_t c, const double* x) const;

  // From the slopes of unit couples on this level.
  Compliance compliance(std::vector<Eigen::Matrix2d> slopes) const;
  // The missing moments on this surface.
  Moments correction(const Compliance& compliance, const double* x) const;
  // sum Omega psi_c^2, u and v apart, which makes moments comparable with loads.
  const Moments& mass() const { return mass_; }
  // Converts moments of another level to this one.
  void carry(const LevelCouples& from, Moments& moments) const;

 private:
  Vec3 goal(std::size_t c, const Couple& slopes) const;
  template <class Visit>
  void visit_points(std::size_t c, Visit&& visit) const;

  const Couples& couples_;
  const GridLevel& grid_;
  std::vector<double> total_;  // sum Omega psi_c . (u, v) for each
  Moments mass_;
};

}  // namespace fairing
