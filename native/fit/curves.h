// SPDX-License-Identifier: GPL-3.0-or-later
// Borders and creases of a surface that is fitted: the control vertices of their curves, which the plate
// does not move, follow the scan's points beside the curves, and its own borders.
#pragma once

#include "fairing/problem.h"
#include "fit/level_fit.h"

namespace fairing {

class CurveFit {
 public:
  // `fixed`: one an input vertex, or empty. References must outlive it.
  CurveFit(const FairingProblem& problem, const Scan& scan, std::span<const std::uint8_t> fixed);

  // Whether any control vertex of a curve may move.
  bool any() const { return any_; }
  // control <- with curves nearer to the scan: each control vertex moves by what the points beside its two
  // curve edges ask for, by least squares [progressive iteration, Deng and Lin 2014]. Points beside a
  // border say how far it is along the normal; on a crease both sides have a say, so that it goes to where
  // they meet.
  void move(const LevelFit& fit, ControlPositions& control) const;

 private:
  // Of least squares for one move: sum of |row . move - offset|^2.
  struct Wish {
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    Vec3 rest = Vec3::Zero();
    void add(const Eigen::Matrix3d& rows, const Vec3& offset, double weight) {
      square += weight * rows;
      rest += weight * rows * offset;
    }
  };
  // Of all points of curves, by their numbers.
  std::vector<Wish> wishes(const LevelFit& fit) const;
  void add_borders(const LevelFit& fit, std::vector<Wish>& wishes) const;

  const FairingProblem& problem_;
  const Scan& scan_;
  std::vector<std::uint8_t> moves_;  // one a control vertex
  bool any_ = false;
};

}  // namespace fairing
