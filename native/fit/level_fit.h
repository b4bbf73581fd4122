// SPDX-License-Identifier: GPL-3.0-or-later
// One level of a surface that is fitted to a scan: iterations of feet, forces and a solve.
#pragma once

#include <cmath>
#include <numbers>

#include "fit/point_forces.h"
#include "thin_plate/levels.h"

namespace fairing {

// Of a plate, by area, and of a curve, by length, against a wave of length 1.
inline const double stiffness_of_wave = std::pow(2 * std::numbers::pi, 4);

// Keeps the surface in place where the scan has no points: a weight and a place each; or empty.
struct Prior {
  VertexWeights weight;
  Array<double> place;  // 3 numbers a point
};

// Data that all levels share. References must outlive them.
struct FitProblem {
  ThinPlateLevels& levels;
  const Scan& scan;
  // The weight of a point is this times the caller's: the stiffness of the plate, by area, against
  // a wave as long as the mean control edge.
  double unit;
  double area;          // of the surface, approximate
  double edge;          // the mean control edge
  int most_iterations;  // of each solve
  const Monitor& monitor;
};

class LevelFit {
 public:
  LevelFit(const FitProblem& problem, int level);

  int level() const { return level_; }
  const Cells& cells() const { return cells_; }
  const FeetFinder& finder() const { return finder_; }
  Workers& workers() const { return problem_.levels.workers(); }
  const Array<double>& surface() const { return x_; }
  const Array<Foot>& feet() const { return feet_; }
  const Scan& scan() const { return problem_.scan; }
  Spread spread() const { return spread_; }
  int iterations() const { return iterations_; }

  // Changes the surface to x, and finds all feet.
  void set_surface(Array<double> x);
  // The same with feet near those of x.
  void set_surface(Array<double> x, Array<Foot> feet);
  // Flags of points that are used; empty: all.
  void train_on(std::vector<std::uint8_t> points) { trained_ = std::move(points); }
  void stay_near(Prior prior) { prior_ = std::move(prior); }
  // Points over a control face act with its share of their force from now on.
  void set_shares(std::vector<double> share) { share_ = std::move(share); }

  // `count` iterations of feet, forces and solve. `robust`: outliers have less weight.
  void iterate(double weight, int count, bool robust);

  // The largest useful weight: for waves as long as the level's edges, or as points are apart.
  double stiffest() const;
  // Mean distance of adjacent points, and of control vertices, in the frame's unit.
  double apart() const { return std::sqrt(problem_.area / double(problem_.scan.size())); }
  double edge() const { return problem_.edge; }
  // How far a surface under points of this weight follows a single one: a plate on springs.
  double share_followed(double weight) const {
    return std::sqrt(weight) * std::pow(2 * std::numbers::pi * apart() / edge(), 2) / 8;
  }

 private:
  void update_spread();
  void compute_forces(double weight, bool robust);
  void solve();

  const FitProblem& problem_;
  int level_;
  Cells cells_;
  FeetFinder finder_;
  PointForces sums_;
  std::vector<std::uint8_t> unknown_;
  std::vector<std::uint8_t> trained_;
  std::vector<double> share_;  // empty: 1
  Prior prior_;
  Array<double> x_, r_, right_side_;  // right_side_ is the right-hand side
  Array<Foot> feet_;
  Array<float> robust_weight_;
  Array<Vec3> force_;
  VertexWeights weight_;
  Spread spread_;
  int iterations_ = 0;
};

}  // namespace fairing
