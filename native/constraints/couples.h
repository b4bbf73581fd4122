// SPDX-License-Identifier: GPL-3.0-or-later
// Fixed normals. That the surface has the normal n at a control vertex c are two conditions on its
// divided differences there, n . x_u = n . x_v = 0, with (u, v) the vertex' chart. What holds them are
// couples, forces along n that turn the surface and do not push it. A couple at a point would hold
// nothing: the slope that it makes grows with every level. So it is spread, as loads are (pads.h),
//
//   K x = … + Omega sum_c n_c psi_c . m_c,   psi_c = (u, v) phi_c,
//
// with phi_c the hat of half the faces around the vertex. Over all of them couples would do nearly
// what loads do. Half hats of two vertices do not meet.
#pragma once

#include <vector>

#include "constraints/pads.h"

namespace fairing {

struct FixedNormal {
  Index vertex;  // off all curves and inside the region
  Vec3 normal;   // of length one
};

// The m_c, one a normal. Their unit is that of loads: (u, v) are shares of the mean radius of the
// vertex' ring.
using Moments = LoadsOf<2>;
// Couples in space, m_u and m_v as columns; and as many slopes x_u and x_v.
using Couple = Eigen::Matrix<double, 3, 2>;

// What they are on all levels.
class Couples {
 public:
  // Levels on which half a hat has points; where there is no such, whole ones serve.
  static constexpr int first_level = 2;

  // Positions of `mesh` in working coordinates.
  Couples(const ControlMesh& mesh, const ChartMaker& charts, std::vector<FixedNormal> normals,
          Workers& workers);

  std::size_t size() const { return normals_.size(); }
  const Vec3& normal(std::size_t c) const { return normals_[c].normal; }

  // Sets of normals so far apart that their couples hardly disturb each other.
  std::vector<std::vector<std::size_t>> sets_apart() const;

 private:
  friend class LevelCouples;
  // One spoke of a vertex' ring, in (u, v): its end, the far corner of the face behind it, and that
  // face's other neighbour of the vertex; and the weights of points on it and inside the face.
  struct Arm {
    Vec2 ahead, far, behind;
    double edge_weight, face_weight;
  };

  void fill_arms(std::size_t c, const Chart& chart, const std::vector<FlatFace>& flat);

  const ControlMesh& mesh_;
  Workers& workers_;
  std::vector<FixedNormal> normals_;
  std::vector<std::size_t> first_arm_, first_row_;  // of each, and the end
  Array<Arm> arms_;
  Array<Vec2> rows_;  // of the first divided differences, one a neighbour
};

// Which slopes a unit couple makes, one matrix a normal, and sum Omega psi_c . (u, v) on the level
// where that was measured. Other levels have nearly the same.
struct Compliance {
  std::vector<Eigen::Matrix2d> slopes;
  std::vector<double> totals;
};

// With hats sampled on a level's points, of edges in two pieces at the least.
class LevelCouples {
 public:
  // Both must outlive it.
  LevelCouples(const Couples& couples, const GridLevel& grid);

  const GridLevel& grid() const { return grid_; }
  std::size_t size() const { return couples_.size(); }

  // r <- r + Omega sum_c n_c psi_c . m_c, 3 numbers a point.
  void add(const Moments& moments, double* r) const;
  // The same of couples along anything.
  void add(const std::vector<Couple>& couples, double* r) const;
  // The slopes of x at the vertex, by its divided differences.
  Couple slopes(std::size_t c, const double* x) const;
  // Between the normal asked for and that of x; radians, from 0 to pi.
  double angle(std::size_t c, const double* x) const;

  // From the slopes of unit couples on this level.
  Compliance compliance(std::vector<Eigen::Matrix2d> slopes) const;
  // What couples lack, as this surface says.
  Moments correction(const Compliance& compliance, const double* x) const;
  // sum Omega psi_c^2, u and v apart: what makes them comparable with loads.
  const Moments& mass() const { return mass_; }
  // moments <- for this level, from those of another.
  void carry(const LevelCouples& from, Moments& moments) const;
  // sum Omega psi_c . (u, v) of each.
  const std::vector<double>& totals() const { return total_; }

 private:
  template <class Visit>
  void visit_points(std::size_t c, Visit&& visit) const;

  const Couples& couples_;
  const GridLevel& grid_;
  std::vector<double> total_;
  Moments mass_;
};

}  // namespace fairing
