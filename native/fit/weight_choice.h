// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the weight of a scan's points: the one with the least error at held-out points, or the
// least one that keeps the surface within a tolerance.
#pragma once

#include <span>
#include <utility>

#include "fit/fit_scan.h"
#include "fit/held_out.h"

namespace fairing {

struct WeightTrial {
  double weight, error;  // root mean square
  double squares;        // the sum over points that are held out
};

class WeightChoice {
 public:
  // `fit` must be on the scan; it ends with the chosen weight's surface. `scale`: of the frame.
  // `has_ends`: the surface has borders or creases.
  WeightChoice(LevelFit& fit, const FitSettings& settings, double scale, bool has_ends)
      : fit_(fit), settings_(settings), scale_(scale), bias_(has_ends ? 5.0 / 4 : 2) {}

  // From the surface of `fit`, which may have changed since the last choice.
  // `is_last`: there is no other choice, so correlated noise matters.
  double choose(Monitor& monitor, bool is_last);
  bool is_by_tolerance() const { return !is_chosen_by_points_ && settings_.tolerance > 0; }
  // Factor of the weight for this total number of points.
  double more_points(std::size_t points) const;

  // Weights tried, and the root mean square error at held-out points, in mesh units.
  const std::vector<std::array<double, 2>>& trials() const { return trials_; }

 private:
  struct Place {
    Array<double> surface;
    Array<Foot> feet;
  };

  double by_held_out(Monitor& monitor, bool is_last);
  std::vector<WeightTrial> search(double weight, std::span<const HeldOut> sets, const Place& start,
                                  Monitor& monitor);
  double by_tolerance(Monitor& monitor);
  Place place() const { return {fit_.surface(), fit_.feet()}; }
  void put(Place place) { fit_.set_surface(std::move(place.surface), std::move(place.feet)); }
  void add_errors(const HeldOut& held, WeightTrial& trial);
  void set_error(WeightTrial& trial, std::size_t tests) const;
  void use(const std::vector<WeightTrial>& trials, const HeldOut& held);

  LevelFit& fit_;
  const FitSettings& settings_;
  double scale_;
  // The square of a plate's bias falls with this power of the weight. At free ends it does not bend,
  // and is off by more, over strips that are narrower for larger weights [Rice, Rosenblatt 1983].
  double bias_;
  std::size_t trained_points_ = 0;
  double shared_ = 0;  // noise that points share
  double cut_ = 0;     // larger distances have less weight
  std::vector<std::array<double, 2>> trials_;
  bool is_chosen_by_points_ = false;
};

}  // namespace fairing
