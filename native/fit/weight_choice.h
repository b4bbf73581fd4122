// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the weight of a scan's points: the one with the least error at held-out points, or the
// least one that keeps the surface within a tolerance.
#pragma once

#include "fit/fit_scan.h"
#include "fit/level_fit.h"

namespace fairing {

// Average number of points in a cell that is held out, or that counts as covered: with this number
// one cell in fifty is empty by chance.
constexpr double points_a_blob = 4;

class WeightChoice {
 public:
  // `fit` must be on the scan; it ends with the chosen weight's surface. `scale`: of the frame.
  WeightChoice(LevelFit& fit, const FitSettings& settings, double scale)
      : fit_(fit), settings_(settings), scale_(scale) {}

  // From the surface of `fit`, which may have changed since the last choice.
  double choose(Monitor& monitor);
  bool is_by_tolerance() const { return !is_chosen_by_points_ && settings_.tolerance > 0; }
  // Factor of the weight for this total number of points.
  double more_points(std::size_t points) const;

  // Weights tried, and the root mean square error at held-out points, in mesh units.
  const std::vector<std::array<double, 2>>& trials() const { return trials_; }

 private:
  double by_held_out(Monitor& monitor);
  double middle_of_good(std::size_t best) const;
  double by_tolerance(Monitor& monitor);
  void hold_out();
  double held_out_error();

  LevelFit& fit_;
  const FitSettings& settings_;
  double scale_;
  struct HeldOut {
    std::size_t point;
    Foot foot;
    Vec3 normal;
  };
  std::vector<std::uint8_t> trained_;
  std::vector<HeldOut> held_;
  double cut_ = 0;  // larger distances have less weight
  std::vector<std::array<double, 2>> trials_;
  bool is_chosen_by_points_ = false;
};

}  // namespace fairing
