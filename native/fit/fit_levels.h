// SPDX-License-Identifier: GPL-3.0-or-later
// A fit level by level: the choice of the weight on a coarse one, then finer and finer surfaces.
#pragma once

#include "fairing/problem.h"
#include "fit/curves.h"
#include "fit/fit_scan.h"
#include "fit/weight_choice.h"

namespace fairing {

// Most cells of the level on which the weight is chosen: that takes some twenty iterations.
constexpr std::size_t cells_of_search = std::size_t(1) << 14;
// Number of points for the choice, points_a_blob for a quarter of each cell; more do not improve it.
constexpr std::size_t enough_points = std::size_t(points_a_blob * points_a_blob) * cells_of_search;

class FitLevels {
 public:
  // References must outlive it.
  FitLevels(const FairingProblem& problem, ThinPlateLevels& levels, const Scan& scan,
            const FitSettings& settings, Monitor& monitor);

  // Throws FairingError if the scan lies elsewhere or is inside out, or cancelled.
  void run(FitReport& report);

  // Of the finest level, once run.
  const Array<double>& surface() const { return surface_; }
  const ControlPositions& control() const { return control_; }

 private:
  FitProblem problem_of(const Scan& scan) const;
  PlateData data() const { return {control_.working, control_.working_curves}; }
  void begin(LevelFit& fit);
  void require_match(const LevelFit& fit) const;
  void fit_curves(LevelFit& fit, double weight, int iterations, bool robust);
  void keep_tolerance(LevelFit& fit);
  Prior prior(const LevelFit& fit) const;
  Array<double> above(const LevelFit& fit);

  const FairingProblem& problem_;
  ThinPlateLevels& levels_;
  const Scan& scan_;
  const FitSettings& settings_;
  Monitor& monitor_;
  ControlPositions control_;
  CurveFit curves_;
  int search_;
  Scan thin_;
  double unit_, area_, weight_ = 0;
  bool is_kept_ = false;  // whether the tolerance is met
  Array<double> surface_;
};

}  // namespace fairing
