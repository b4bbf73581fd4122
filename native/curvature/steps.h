// SPDX-License-Identifier: GPL-3.0-or-later
// Gauss-Newton steps on one level, to least total curvature and to least variation of curvature.
#pragma once

#include "base/roundoff.h"
#include "curvature/local_damping.h"
#include "curvature/options.h"
#include "curvature/system.h"

namespace fairing {

// The condition for the last step. If `decrement` is positive: a step with at most that decrement;
// else one after which the estimated distance to the solution is at most `movement`. Also two
// successive damped steps that together gain less than the share `gain` of the energy.
struct StopCriterion {
  double decrement = 0;
  double movement = 0;
  double gain = 0;

  // `left`: the estimated distance after the step (error_estimate.h).
  bool is_reached(double step_decrement, double left) const {
    return decrement > 0 ? step_decrement <= decrement : left <= movement;
  }
};

// Damped steps end at this decrement, the largest that counts as near a solution: its square, the
// relative gain of a full step, is below a thousandth.
constexpr double damped_decrement = 3e-2;

// Plain steps must reach this decrement in time; on coarse levels they end there.
constexpr double plain_decrement = 1e-3;

// A surface from another method may have this many times the energy of the one that it replaces:
// the solution of the equation is not exactly the minimum of the discrete energy.
constexpr double equal_energy = 1.01;
// The same between surfaces on pads and on points, or with fewer folds, which are different minima.
constexpr double other_minimum = 1.15;
// A surface with this many times the energy of another is not comparable with it.
constexpr double incomparable_energy = 1.5;
// An energy below this is rounding: a sphere has 8 pi, a plane zero.
constexpr double flat_energy = roundoff;

// Number of steps in which plain steps reach plain_decrement, or never do.
constexpr int plain_patience = 14;
// Most successive plain steps that may raise the energy; the next one must reach a new minimum.
// Also the number in which plain steps after damped ones reach plain_decrement, or never do.
constexpr int longest_climb = 3;

// Whether the steps have come near a solution: the last one was accepted, and its decrement is at
// most this. The promised accuracy may need more steps.
bool is_near(const CurvatureLevelReport& report, double decrement);

// The start of the steps on a level: points, multipliers, and the report before the first step.
struct StepStart {
  Array<double> points;
  Multipliers<1> held;
  CurvatureLevelReport report;
};

constexpr Functional of_variation{CurvatureEnergy::minimum_variation, nullptr, true};

// Minimum variation's energy that counts as zero, since a sphere has none. Zero for total
// curvature.
double flat_energy_about(const LinearizedSurface& surface, Workers& workers);

// Two methods. Plain steps have full length: they may pass humps of the discrete energy, which stop
// steps that must lower it, and may raise it a few times in a row (the watchdog technique of
// Chamberlain et al. 1982). Damped steps converge where a surface is crumpled and plain ones
// diverge. Both are accelerated near the end (constraints/anderson.h). All move iterate.current and
// throw ErrorCode::cancelled.

// Plain steps with control vertices on these pads; null: on point forces. Adds the steps to
// `report`, and sets energy, `left` and `converged`.
void run_plain(SurfaceIterate& iterate, const Pads* pads, const StopCriterion& end,
               CurvatureLevelReport& report);
// Damped steps on point forces from `start` to damped_decrement, or until the gain is too small.
// Resets `report`. Points that are `filled` (above zero; empty: none) are damped throughout.
void run_damped(SurfaceIterate& iterate, const StepStart& start, const Array<float>& filled,
                CurvatureLevelReport& report);
// Damped steps on point forces to least variation. Adds the steps to `report`, and sets `left` and
// `converged`.
void run_to_variation(SurfaceIterate& iterate, const StopCriterion& end,
                      CurvatureLevelReport& report);
// Plain steps to the step tolerance, on the present pads. If they do not come near it, or end with
// more energy, surface and report are restored.
void polish(SurfaceIterate& iterate, int patience, CurvatureLevelReport& report);

// The end at which the surface is as near to the solution as promised.
inline StopCriterion accurate_end(const SurfaceIterate& iterate) {
  return {0, iterate.system.options().step_tolerance};
}

}  // namespace fairing
