// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "check/error.h"
#include "solver/hierarchy.h"

namespace fairing {

struct SurfaceEnergies {
  double thin_plate = 0;       // in the control metric, on the finest level; mesh units^(2 - 2 exponent)
  double total_curvature = 0;  // integral of k1^2 + k2^2 over the surface; a pure number
};

// `residual` and `residuals` (after 0, 1, … iterations) are relative to the residual of the control polyhedron on that
// level; `energy_error` estimates |error| over the solution, both in the energy norm.
struct LevelReport : LevelSolve {
  int level = 0;
  std::size_t points = 0;
  std::size_t unknowns = 0;
};

// One Gauss-Newton step.
struct StepReport {
  bool variation = false;  // towards the least variation of curvature, not the least total curvature
  double energy = 0;       // before it
  double decrement = 0;    // sqrt(h . K h / energy): how much of the energy's root a full step would take off
  double length = 1;       // of the part of the step that was gone; 0: none would do
  double movement = 0;     // of any point, at most, in working coordinates
  int iterations = 0;      // of the linear solve
  double residual = 0;     // its, relative to the start
  bool direct = false;
};

struct CurvatureLevelReport {
  int level = 0;
  double plate_energy = 0, start_energy = 0, energy = 0;  // in working coordinates
  double start_variation = 0, variation = 0;              // minimum variation, on the finest level
  std::size_t folds_before = 0, folds = 0;                // that the control mesh does not have (folds.h)
  std::vector<StepReport> steps;
  bool converged = false;  // to a decrement of 3e-2 at the least, with which its square is below 1e-3
  bool accurate = false;   // to options.step_tolerance
};

struct ShapeReport {
  LevelReport finest;
  double largest_deviation = 0;  // as in Report
  int constraint_rounds = 0;
};

struct PhaseSeconds {
  std::string phase;
  double seconds;
};

struct Report {
  SurfaceEnergies result, polyhedron, prediction;
  std::vector<LevelReport> levels;
  std::vector<CurvatureLevelReport> curvature;  // Gauss-Newton steps by level; none for the thin plate
  std::vector<ShapeReport> shapes;
  std::vector<PhaseSeconds> seconds;
  std::size_t predicted_bytes = 0, peak_bytes = 0;
  double largest_deviation = 0;  // of an input vertex from its place, in mesh units
  int constraint_rounds = 0;     // solves that tolerance or epsilon took
  double constraint_gap = 0;     // tolerance: how far the energy may be over the least possible one, relative
  int threads = 1;
  bool warm = false;  // started from an earlier surface
  std::vector<Warning> warnings;
  std::vector<std::int64_t> flipped_faces;
};

}  // namespace fairing
