// SPDX-License-Identifier: GPL-3.0-or-later
// How strongly a scan's points are to pull: so that points held out are nearest to the surface, or so
// weakly that it just stays within a tolerance.
#pragma once

#include "fit/fit_scan.h"
#include "fit/level_fit.h"

namespace fairing {

// On average, in a cell that is held out, where fewer would be single points, or that counts as covered:
// one in fifty has none by chance.
constexpr double points_a_blob = 4;

class WeightChoice {
 public:
  // `fit` is on the scan already; it is left with the surface of the weight chosen. `scale`: of the
  // frame.
  WeightChoice(LevelFit& fit, const FitSettings& settings, double scale)
      : fit_(fit), settings_(settings), scale_(scale) {}

  double choose(Monitor& monitor);
  bool is_by_tolerance() const { return !is_chosen_by_points_ && settings_.tolerance > 0; }
  // What the weight is to be multiplied by where there are so many points in all.
  double more_points(std::size_t points) const;

  // Weights tried, and the root mean square of what points held out were off, in mesh units.
  const std::vector<std::array<double, 2>>& trials() const { return trials_; }

 private:
  double by_held_out(Monitor& monitor);
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
  double cut_ = 0;  // beyond it a distance counts less
  std::vector<std::array<double, 2>> trials_;
  bool is_chosen_by_points_ = false;
};

}  // namespace fairing
