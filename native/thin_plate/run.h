// SPDX-License-Identifier: GPL-3.0-or-later
// One level of the plate: what a level of a nested solve, of that of a difference, and a solve on the
// finest level alone have in common.
#pragma once

#include "constraints/held_solve.h"
#include "thin_plate/solver.h"

namespace fairing {

struct ThinPlateSolver::Run {
  ThinPlateSolver& solver;
  const PlateData& data;
  PlateState& state;
  Array<double>& x;                  // of the level
  Array<double> r{};                 // its residual
  Array<double> goal{};              // that it is drawn to; or empty
  double rough_force = 0;            // of what loads carry: the forces that may be left anyway
  std::span<const double> forces{};  // on the points of the finest level; or empty

  ThinPlateLevels& levels() const { return solver.levels_; }
  int base() const { return levels().base(); }
  int top() const { return levels().top(); }
  std::size_t size(int level) const { return 3 * levels().grid(level).size(); }

  // x and r get room. Then the level's metric, where it is to have that of a surface: of its start, on
  // the coarsest level of the goal.
  void begin(int level, const PlateSurface& below);
  // State, forces and x <- the start of a level. `foretells`: whether forces say how loads change.
  void start(int level, bool foretells, const PlateSurface& below, Loads& forces);

  PcgLimits limits(int level, double tolerance, double energy, double* room);

  struct Solved {
    LevelReport report;
    LevelSolve equivalent;  // what one solve in place of the level's many would have taken
  };
  // `constraints`, which may be null, choose the weights (solve_held.cpp).
  Solved solve(int level, const PcgLimits& limits, BallConstraints* constraints);
  HeldLimits held_limits(int level, const PcgLimits& limits) const;

  // A report of a level that has not been solved yet.
  LevelReport report_of(int level) const;
  // Of the finest level's solve, from 0 to 1.
  void report_done(int level, double done) const;
};

}  // namespace fairing
