// SPDX-License-Identifier: GPL-3.0-or-later
// Options and reports of the thin plate's solver.
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
  double pad_size = 0;               // of the pads (constraints/pads.h); 0: point forces
  std::vector<FixedNormal> normals;  // fixed on all levels but the coarsest
  // The penalty on the distance from a reference, in the metric of the surface from which a level
  // starts; null: the control metric and no penalty.
  struct Penalty {
    std::shared_ptr<const Array<float>> of_points;  // SurfaceMetric::penalty, on the finest level
    double exponent = 0;                            // of the metric
  } penalty;
  bool starts_steps = false;  // Gauss-Newton steps follow, which take most of the run
};

// Relative residual of a solve whose surface is only a start, or whose loads are only read. With it
// strain is within 0.6 % of the largest of what a tenth of it gives.
constexpr double difference_tolerance = 1e-2;

// What may be left on the finest level. Force on a control vertex, relative; it leaves the same
// share of the point force's spot. With 2e-3 positions are within 5.3e-5 of the mesh's size on 36
// smooth and rough meshes (5e-4: within 5e-6, for a sixth more iterations and twice those of a
// drag). Angle to a fixed normal, in radians: a twentieth of a degree.
constexpr double largest_force_left = 2e-3, largest_angle_left = 8e-4;

// `residual` and `residuals` are relative to the residual of the control polyhedron on that level;
// `energy_error` is the estimated |error| over the solution, both in the energy norm.
struct LevelReport : LevelSolve, HeldReport {
  int level = 0;
  std::size_t points = 0;
  std::size_t unknowns = 0;
};

}  // namespace fairing
