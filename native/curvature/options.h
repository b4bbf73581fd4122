// SPDX-License-Identifier: GPL-3.0-or-later
// What the Gauss-Newton solver is asked, and what it answers. Lengths and energies are in working
// coordinates, where the mesh's size is about one.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "constraints/held_report.h"
#include "multigrid/solve_options.h"

namespace fairing {

// The functional whose rows are assembled. Displacing a surface by h along its normals turns its
// metric by -2 h M, so that J h has a term of h itself beside the Hessian of h:
//
//   total_curvature     h (M^2 - tr(M) M / 2): the variation of |M|^2 dA, the change of area in it
//   minimum_variation   h M^2: the variation of the shape operator alone
enum class CurvatureEnergy { total_curvature, minimum_variation };

struct GaussNewtonOptions {
  // What the finest level's surface minimizes. Coarser levels minimize total curvature, and look
  // ahead to less variation from there (variation.h).
  CurvatureEnergy energy = CurvatureEnergy::total_curvature;
  // So many times the surface's area is minimized with total curvature; 0 for minimum variation.
  double tension = 0;
  // Steps end where less is left to move, in working units (the mesh's size is about one).
  double step_tolerance = 0;
  // How exact the loads on pads have to be: what is left of the force, relative.
  double load_tolerance = 0;
  int max_steps = 20;  // on each level, for each way of stepping that is tried there
  SolveOptions solve;
};

// One Gauss-Newton step.
struct StepReport : HeldReport {
  bool variation = false;  // of minimum variation; else of total curvature
  double energy = 0;       // before the step, tension's part included
  // sqrt(h . K h / energy): the share of the energy's root that a full step would take off.
  double decrement = 0;
  double length = 1;     // the share of the step that was taken; 0: rejected
  double movement = 0;   // the farthest that the last trial took any point
  int iterations = 0;    // of the linear solve
  double residual = 0;   // of the linear solve, relative to its start
  bool solved = true;    // whether it came to its end
  bool direct = false;   // solved by a factorization, without iterations
  double load_work = 0;  // of a full step against the loads on pads
};

// What a level took, all that was tried and left included.
struct StepWork {
  int steps = 0, linearizations = 0;  // of the level itself
  int iterations = 0, pad_corrections = 0;
  int factors = 0;  // of all levels

  StepWork operator-(const StepWork& o) const {
    return {steps - o.steps, linearizations - o.linearizations, iterations - o.iterations,
            pad_corrections - o.pad_corrections, factors - o.factors};
  }
};

// Energies are of curvature alone where the solver returns; steps judge by tension's part too.
struct CurvatureLevelReport {
  int level = 0;
  double plate_energy = 0;  // total curvature of the thin plate's surface
  double start_energy = 0;  // of the surface that the steps started from
  double energy = 0;        // of the surface returned
  // Minimum variation's energy before its steps and after them; on the finest level alone.
  double start_variation = 0, variation = 0;
  double constraint_gap = 0;  // of the last step
  // Folded edges that the control mesh does not have (folds.h), before unfolding and after it.
  std::size_t folds_before = 0, folds = 0;
  std::vector<StepReport> steps;
  int last_steps = 0;  // of the last way of stepping, which max_steps bounds
  StepWork work;
  // How far the surface is from the solution of its equation, as its last steps tell
  // (left_to_move.h); infinity where they tell nothing.
  double left = std::numeric_limits<double>::infinity();
  // The one meaning of converged, for both energies: the surface is as near to the solution of its
  // equation as was promised. On the finest level `left` is below the step tolerance. Surfaces of
  // other levels only start the next one; there a decrement of 3e-2 at the most is promised.
  bool converged = false;
  // The steps ended at a worse surface than they began at, which is kept in its place.
  bool kept_start = false;
  // The level below is a bubble (grid/thickness.h), the energy's least perhaps, to which few steps do
  // not lead: the thin plate's surface is kept in its place.
  bool swollen = false;
  // Plain steps did not lead to this surface: there may be others, and which one is found may hang
  // on how the mesh lies and is numbered.
  bool damped = false;
};

}  // namespace fairing
