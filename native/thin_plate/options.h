// SPDX-License-Identifier: GPL-3.0-or-later
// What the thin plate's solver is asked, and what it answers.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "constraints/couples.h"
#include "constraints/held_report.h"
#include "grid/grid_level.h"
#include "multigrid/hierarchy.h"
#include "multigrid/solve_options.h"

namespace fairing {

struct ThinPlateOptions {
  int levels = 3;  // of refinement; the finest has edges in 2^levels pieces
  SolveOptions solve;
  double pad_size = 0;               // of the pads under control vertices (pads.h); 0: point forces
  std::vector<FixedNormal> normals;  // held on all levels but the coarsest
  // Where the plate is drawn to a goal, in the metric of the surface that a level starts from; null: in
  // the control metric, and drawn nowhere.
  struct Pull {
    std::shared_ptr<const Array<float>> of_points;  // SurfaceMetric::pull, on the finest level
    double exponent = 0;                            // of the metric
  } pull;
  bool starts_steps = false;  // Gauss-Newton steps follow, which take most of the run
};

// Of a solve whose surface is only the start of others, or that loads are only read off: the relative
// residual. Strain is within 0.6 % of the largest with what a tenth of it gives.
constexpr double difference_tolerance = 1e-2;

// What is left on the finest level at the most where all has settled. Of the force on a control vertex,
// what leaves as much of its spot: with 2e-3 positions are within 5.3e-5 of the mesh's size on 36 smooth
// and rough meshes (5e-4: within 5e-6, for a sixth more iterations and twice those of a drag). And of
// the angle to a fixed normal, radians: a twentieth of a degree.
constexpr double largest_force_left = 2e-3, largest_angle_left = 8e-4;

// `residual` and `residuals` are relative to the residual of the control polyhedron on that level;
// `energy_error` estimates |error| over the solution, both in the energy norm.
struct LevelReport : LevelSolve, HeldReport {
  int level = 0;
  std::size_t points = 0;
  std::size_t unknowns = 0;
};

}  // namespace fairing
