// SPDX-License-Identifier: GPL-3.0-or-later
// Options and reports of the Gauss-Newton solver. Lengths and energies are in working coordinates,
// where the mesh's size is about one.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "constraints/held_report.h"
#include "multigrid/solve_options.h"

namespace fairing {

// The functional whose rows are assembled. Displacing a surface by h along its normals changes its
// metric by -2 h M, so J h has, beside the Hessian of h, the term
//
//   total_curvature     h (M^2 - tr(M) M / 2): the variation of |M|^2 dA, with the change of area
//   minimum_variation   h M^2: the variation of the shape operator alone
enum class CurvatureEnergy { total_curvature, minimum_variation };

struct GaussNewtonOptions {
  // The functional that the finest level minimizes. Coarser levels minimize total curvature, and
  // then variation as a start for the next level (variation.h).
  CurvatureEnergy energy = CurvatureEnergy::total_curvature;
  // Factor of the surface's area in the energy; 0 for minimum variation.
  double tension = 0;
  // Steps end when the estimated distance to the solution is below this, in working units.
  double step_tolerance = 0;
  // Tolerance of the loads on pads: the remaining force, relative.
  double load_tolerance = 0;
  int max_steps = 20;  // on each level, for each method that is tried
  SolveOptions solve;
};

// One Gauss-Newton step.
struct StepReport : HeldReport {
  bool variation = false;  // for minimum variation; else for total curvature
  double energy = 0;       // before the step, with that of tension
  // sqrt(h . K h / energy): a full step lowers the root of the energy by this share.
  double decrement = 0;
  double length = 1;     // share of the full step that was taken; 0: rejected
  double movement = 0;   // largest move of a point by the last trial
  int iterations = 0;    // of the linear solve
  double residual = 0;   // of the linear solve, relative to its start
  bool solved = true;    // whether the linear solve converged
  bool direct = false;   // solved by a factorization, without iterations
  double load_work = 0;  // work of the loads on pads in a full step
};

// Work on a level, including attempts that were discarded.
struct StepWork {
  int steps = 0, linearizations = 0;  // of the level itself
  int iterations = 0, pad_corrections = 0;
  int factors = 0;  // of all levels

  StepWork operator-(const StepWork& o) const {
    return {steps - o.steps, linearizations - o.linearizations, iterations - o.iterations,
            pad_corrections - o.pad_corrections, factors - o.factors};
  }
};

// Energies are without tension once the solver returns; steps compare them with tension.
struct CurvatureLevelReport {
  int level = 0;
  double plate_energy = 0;  // total curvature of the thin plate's surface
  double start_energy = 0;  // of the surface that the steps started from
  double energy = 0;        // of the surface returned
  // Energy of minimum variation before and after its steps; on the finest level only.
  double start_variation = 0, variation = 0;
  double constraint_gap = 0;  // of the last step
  // Folded edges that the control mesh does not have (folds.h), before and after fold repair.
  std::size_t folds_before = 0, folds = 0;
  std::vector<StepReport> steps;
  int last_steps = 0;  // with the last method, for which max_steps is the limit
  StepWork work;
  // Distance from the solution, estimated (error_estimate.h); infinity if unknown.
  double left = std::numeric_limits<double>::infinity();
  // Whether the surface is as near to the solution of its equation as promised, for both energies.
  // On the finest level `left` is at most the step tolerance. Coarser levels only start the next
  // one; there the decrement is at most 3e-2.
  bool converged = false;
  // The steps ended at a worse surface than their start, which was kept.
  bool kept_start = false;
  // The level below is a bubble (grid/thickness.h), perhaps the energy's minimum, which a few steps
  // do not reach; the thin plate's surface was kept.
  bool swollen = false;
  // Plain steps did not lead to this surface: there may be other minima, and the one found may
  // depend on the position and numbering of the mesh.
  bool damped = false;
};

}  // namespace fairing
