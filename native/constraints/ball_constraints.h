// SPDX-License-Identifier: GPL-3.0-or-later
// Control vertices that move in space, under the thin plate: each stays within a ball.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "constraints/control_constraints.h"

namespace fairing {

// Minimizes the energy while control vertices stay within their tolerances of their targets. Each
// is on a spring of weight w, which pulls it from x towards its shifted target a. With P the part
// of its force w (a - x) that is not that of the caller's own spring, the solution satisfies
//
//   P = lambda (target - x),   lambda >= 0,   and lambda = 0 within the ball.
//
// A vertex with the surface's stiffness s would go from x to x', the point of the ball nearest to x
// - P / s, and need the force F + s (x' - x) there; so its target shifts by
//
//   (1 + s / w) (x' - x),
//
// which is zero at the solution. It is a semi-smooth Newton step with a diagonal for the surface's
// part. Along the ball a spring of weight lambda has the derivative of the law above; across it a
// stiffer one is better. So weights are a few lambdas of the level below, and stay on a level.
class BallConstraints : public ControlConstraints {
 public:
  // `stiffness` of the surface at each control vertex, against moving it alone. It must outlive the
  // constraints.
  BallConstraints(ControlConstraints constraints, std::span<const double> stiffness)
      : ControlConstraints(std::move(constraints)), stiffness_(stiffness) {
    weights_ = start_weights();
  }

  // The points to which the springs pull control vertices.
  std::span<const Vec3> shifted_targets() const { return shifted_.empty() ? targets_ : shifted_; }

  // In all of these `at` has the control vertices, 3 numbers each.

  // Whether the duality gap is at most `wanted`. Computes P.
  bool settled(double energy, double wanted, const double* at);
  // New springs with corrected targets, from the forces of the last settled().
  void renew_springs(const double* at);
  // The same if the springs are still the first ones or have diverged. Returns whether it did.
  bool renew(const double* at, bool loads_settled, double* x);
  // The shift of the targets, 3 numbers a control vertex; adds the springs' additional pull to
  // `forces`.
  std::vector<double> correction(const double* at, Loads& forces) const;
  void shift(const std::vector<double>& shifts);

  // For each number of a correction the factor that makes it comparable with a change of its load:
  // the square of its force over the hat's total; a vertex without a pad has the mean of the
  // others. Empty if no constraint is active. `hats` may be null.
  std::vector<double> comparable(const Hats* hats) const;

 private:
  Vec3 move_of(const double* at, std::size_t v) const;  // x' - x
  // Whether the gap exceeds the whole energy. If many vertices move together, the surface is far
  // softer than each one's stiffness, and the correction of one moves all of them far away.
  bool diverged() const { return gap_ > 1 && first_gap_ < 1; }
  bool leaves_ball(const double* at, std::size_t v) const;

  std::span<const double> stiffness_;
  std::vector<Vec3> shifted_;  // empty: the targets
  std::vector<Vec3> forces_;   // P; empty: not computed yet
  double first_gap_ = 0;       // with these springs; 0: not computed yet
  // Least weight of springs of vertices outside their balls, in stiffnesses of the surface; nonzero
  // once springs have diverged.
  double weight_outside_ = 0;
};

}  // namespace fairing
