// SPDX-License-Identifier: GPL-3.0-or-later
// One level of the plate: the common part of a nested solve, of the solve of a difference, and of a
// solve on the finest level alone.
#pragma once

#include "constraints/held_solve.h"
#include "thin_plate/solver.h"

namespace fairing {

struct ThinPlateSolver::Run {
  ThinPlateSolver& solver;
  const PlateData& data;
  PlateState& state;
  Array<double>& x;           // of the level
  Array<double> r{};          // of x
  Array<double> reference{};  // of the penalty; or empty
  double rough_force = 0;     // force that may be left, as a share of the loads

  ThinPlateLevels& levels() const { return solver.levels_; }
  int base() const { return levels().base(); }
  int top() const { return levels().top(); }
  std::size_t size(int level) const { return 3 * levels().grid(level).size(); }

  // Allocates x and r. Then sets the level's metric if it is that of a surface: that of its start,
  // or of the reference on the coarsest level.
  void begin(int level, const PlateSurface& below);
  // State, forces and x <- the start of a level. `foretells`: whether `forces` predict the change
  // of the loads.
  void start(int level, bool foretells, const PlateSurface& below, Loads& forces);

  PcgLimits limits(int level, double tolerance, double energy, double* room);

  struct Solved {
    LevelReport report;
    LevelSolve equivalent;  // one solve equivalent to the level's many
  };
  // `constraints`, which may be null, choose the weights (solve_held.cpp).
  Solved solve(int level, const PcgLimits& limits, BallConstraints* constraints);
  HeldLimits held_limits(int level, const PcgLimits& limits) const;

  // A report of a level before its solve.
  LevelReport report_of(int level) const;
  // Progress of the finest level's solve, from 0 to 1.
  void report_done(int level, double done) const;
};

}  // namespace fairing
