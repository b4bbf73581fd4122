// SPDX-License-Identifier: GPL-3.0-or-later
// Borders and creases of a fitted surface. The plate does not move the control vertices of these
// curves; they follow the scan's points next to the curves, and the scan's own borders.
#pragma once

#include "fairing/problem.h"
#include "fit/level_fit.h"

namespace fairing {

class CurveFit {
 public:
  // `fixed`: one for each input vertex, or empty. References must outlive it.
  CurveFit(const FairingProblem& problem, const Scan& scan, std::span<const std::uint8_t> fixed);

  // Whether any control vertex of a curve may move.
  bool any() const { return any_; }
  // Moves curves nearer to the scan: their control vertices move by a least-squares fit to the
  // points next to them [progressive iteration, Deng and Lin 2014]. At a border points give the
  // distance along the normal; at a crease those of both sides do. The curves bend as little as the
  // surface of this `weight`: both cut off the same wavelength.
  void move(const LevelFit& fit, double weight, ControlPositions& control) const;

 private:
  // Normal equations of one move: the sum of |row . move - offset|^2.
  struct MoveEquations {
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    Vec3 rest = Vec3::Zero();
    double of_border = 0;  // the weight of the scan's border points
    void add(const Eigen::Matrix3d& rows, const Vec3& offset, double weight) {
      square += weight * rows;
      rest += weight * rows * offset;
    }
  };
  // The second divided difference of a chain at its vertex at[1], by the lengths of the given
  // control edges in mean ones: it also keeps the spacing of the vertices, of which the points
  // know nothing.
  struct Bend {
    std::array<Index, 3> at;
    std::array<double, 3> row;
  };
  bool is_border(Index e) const {
    return problem_.mesh.feature_edge[e] && problem_.mesh.edges[e].boundary();
  }
  void find_bends();
  void find_borders(const Scan& scan);
  // From a border to the scan's.
  double reach() const { return problem_.units.edge_in_space / 2; }
  Eigen::Matrix3d stiffness(const LevelFit& fit, double weight, const Bend& bend,
                            const MoveEquations& points, std::span<const Vec3> place) const;
  std::vector<Vec3> moves(const LevelFit& fit, double weight,
                          const std::vector<MoveEquations>& equations,
                          std::span<const Vec3> place) const;
  // All add to one set of equations for each control vertex of the input.
  void add(Index e, double along, double weight, const Eigen::Matrix3d& rows, const Vec3& offset,
           std::vector<MoveEquations>& equations, bool is_of_border = false) const;
  void add_points(const LevelFit& fit, double weight, std::vector<MoveEquations>& equations) const;
  void add_borders(const LevelFit& fit, std::vector<MoveEquations>& equations) const;

  const FairingProblem& problem_;
  std::vector<Vec3> border_;         // the scan's border points near the drawn borders
  std::vector<std::uint8_t> moves_;  // one a control vertex
  std::vector<Bend> bends_;
  bool any_ = false;
};

}  // namespace fairing
