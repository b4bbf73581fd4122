// SPDX-License-Identifier: GPL-3.0-or-later
// Gauss-Newton steps on one level: to the least total curvature, and to the least variation of
// curvature.
#pragma once

#include "base/rounding.h"
#include "curvature/local_damping.h"
#include "curvature/options.h"
#include "curvature/system.h"

namespace fairing {

// Which steps are the last ones: those of a decrement, or else, where `decrement` is zero, those
// after which less than `movement` is left to move; and two damped ones that together gain less than
// the share `gain` of the energy.
struct StepEnd {
  double decrement = 0;
  double movement = 0;
  double gain = 0;

  // `left`: to move after a step of that decrement (left_to_move.h).
  bool is_reached(double step_decrement, double left) const {
    return decrement > 0 ? step_decrement <= decrement : left <= movement;
  }
};

// Where damped steps end, and the decrement that counts as near at the least: its square, which is
// what a full step gains of the energy, is below a thousandth.
constexpr double damped_decrement = 3e-2;

// Plain steps have to come to this decrement in time; on coarse levels they end there.
constexpr double plain_decrement = 1e-3;

// A surface found in another way may have this many times the energy of the one it replaces: the
// equation's solution lies beside the minimum of the discrete energy.
constexpr double equal_energy = 1.01;
// On pads, on points, or with fewer folds it is another least energy: it may be so many times the one.
constexpr double anothers_least = 1.15;
// One with this many times the energy of another has little to do with it.
constexpr double unlike_energy = 1.5;
// An energy that is rounding: a sphere has 8 pi, a plane none.
constexpr double flat_energy = rounding;

// Plain steps have come to plain_decrement after so many, or never will; and where steps before have
// come near the solution.
constexpr int long_patience = 14, short_patience = 6;
// So many plain steps in a row may climb; the next one has to come below the lowest place so far. As
// many after damped ones have come to plain_decrement, or never will.
constexpr int longest_climb = 3;

// Whether the steps have come near a solution: the last one was taken, and its decrement is at most
// this. Nearer steps may still be needed for what was promised.
bool is_near(const CurvatureLevelReport& report, double decrement);

// Where the steps on a level began: their points, what held them, and the report before the first
// step.
struct StepStart {
  Array<double> points;
  Multipliers<1> held;
  CurvatureLevelReport report;
};

constexpr Functional of_variation{CurvatureEnergy::minimum_variation, nullptr, true};

// What is no variation about a surface: a sphere has none. Zero for total curvature.
double flat_energy_about(const LinearizedSurface& surface, Workers& workers);

// Two ways to step. Plain steps are full ones: they may climb over humps of the discrete energy,
// where checked ones are trapped, a few in a row (the watchdog technique of Chamberlain et al. 1982).
// Damped steps hold where a surface is crumpled, and plain ones run wild. Both are accelerated near
// the end (constraints/anderson.h).
class CurvatureSteps {
 public:
  // All must outlive it.
  CurvatureSteps(SurfaceIterate& iterate, const GaussNewtonOptions& options)
      : iterate_(iterate), options_(options) {}

  // From iterate.current to the surface that the steps end at, its control vertices on these pads;
  // null: on point forces. `report` has the steps added, and energy, `left` and `converged` set, the
  // latter for the end that was asked for. Throws ErrorCode::cancelled.
  void run_plain(Pads* pads, const StepEnd& end, int patience, CurvatureLevelReport& report);
  // From `start` to damped_decrement, or as far as steps gain something worth it. `report` begins
  // anew. Points that are `filled` (above zero; empty: none) are damped throughout.
  void run_damped(Pads* pads, const StepStart& start, const Array<float>& filled,
                  CurvatureLevelReport& report);

  // From iterate.current to the least variation, by damped steps on point forces. `report` has the
  // steps added, and `left` and `converged` set.
  void run_variation(const StepEnd& end, CurvatureLevelReport& report);

  // Plain steps to the step tolerance, on what the surface stands on. Unless they come near it, with
  // hardly more energy, surface and report are as before.
  void polish(int patience, CurvatureLevelReport& report);

  // Where the surface is as near to the solution as was promised.
  StepEnd accurate_end() const { return {0, options_.step_tolerance}; }

 private:
  void run(Pads* pads, LocalDamping* damping, const StepEnd& end, int patience,
           CurvatureLevelReport& report);

  SurfaceIterate& iterate_;
  const GaussNewtonOptions& options_;
};

}  // namespace fairing
