// SPDX-License-Identifier: GPL-3.0-or-later
// The Gauss-Newton systems K h = f of all levels about one surface, and linear solves with them:
// conjugate gradients around V-cycles, whose transfers are those of the thin plate. And the surface
// itself, with its linearization and a trial beside it: what all kinds of steps work on.
#pragma once

#include <memory>
#include <vector>

#include "constraints/held_solve.h"
#include "curvature/level.h"
#include "curvature/options.h"
#include "grid/symmetrize.h"
#include "multigrid/hierarchy.h"
#include "parallel/monitor.h"
#include "transfer/level_transfer.h"

namespace fairing {

// Of all levels; they must outlive the system.
using GridLevels = std::vector<const GridLevel*>;

// Keeps mirror symmetries: surfaces and steps become the mean with their mirror images. Rounding
// differs between the two sides of a mirror, and steps over crumpled places amplify the difference
// until damping decides differently on either side, so this is needed after every step.
class Symmetrizer {
 public:
  Symmetrizer(Mirrors mirrors, const Unknowns& unknowns, Workers& workers)
      : mirrors_(std::move(mirrors)), unknowns_(unknowns), workers_(workers) {}

  void set_mirrors(Mirrors mirrors) { mirrors_ = std::move(mirrors); }

  // 3 numbers a point; what is no unknown stays.
  void points(const GridLevel& grid, Array<double>& x) const;
  // 1 number a point, along the normals.
  void displacements(const GridLevel& grid, Array<double>& h) const;

 private:
  Mirrors mirrors_;
  const Unknowns& unknowns_;
  Workers& workers_;
};

struct LinearizedSurface {
  Array<double> points;  // 3 numbers a point, in working coordinates
  Functional functional;
  Linearization linearization;  // of the functional about `points`
  double energy = 0;
  int number = 0;       // which of its level's linearizations it is: K is about the latest
  Multipliers<1> held;  // what holds its control vertices; empty: not known
};

// Decrement below which the surface changes so little from step to step that coarse levels, their
// factor and the spectra serve as they are.
constexpr double settling_decrement = 0.1;

// What solves leave of their error where what they solve for is about to change: loads, and ends.
constexpr double inexact = 0.1;

class GaussNewtonSystem {
 public:
  // `levels`: all from 0 on; those below `base` have no unknowns worth a solve. `constraints`: what holds the
  // control vertices that move, along the normals, while total curvature is minimized, until let_go();
  // or null. All references must outlive the system.
  GaussNewtonSystem(const ControlMesh& mesh, const GridLevels& grids, int base,
                    const Stencils& stencils, const Unknowns& unknowns,
                    const GaussNewtonOptions& options, IntervalConstraints* constraints,
                    Mirrors mirrors, Workers& workers, Monitor& monitor);
  ~GaussNewtonSystem();
  GaussNewtonSystem(const GaussNewtonSystem&) = delete;  // its parts refer to each other

  int base() const { return base_; }
  int finest() const { return int(grids_.size()) - 1; }
  const ControlMesh& mesh() const { return shared_.mesh; }
  const GridLevel& grid(int level) const { return *grids_[std::size_t(level)]; }
  CurvatureLevel& op(int level) { return *operators_[std::size_t(level - base_)]; }
  const Stencils& stencils() const { return stencils_; }
  CurvatureShared& shared() { return shared_; }
  Symmetrizer& symmetrizer() { return symmetrizer_; }
  Workers& workers() { return shared_.workers; }

  // The surface's linearization about its points, and with it K of `level`.
  void linearize(int level, LinearizedSurface& surface);
  // The systems of the levels below `level` about a surface of that level, injected.
  void linearize_below(int level, const LinearizedSurface& about);

  // mu_i K_ii is added to the diagonal of `level`, and injected of those below; empty: nothing.
  // `share`: as for CurvatureLevel.
  void set_damping(int level, const Array<float>& mu, double share);

  // From here on nothing holds control vertices: those that are none of `unknowns` stay. The systems
  // of `level` and below are linearized about `surface`, with factors of those unknowns.
  void let_go(Unknowns unknowns, int level, LinearizedSurface& surface);
  // Whether it keeps any within a tolerance, and the gap that is wanted then on a level.
  bool is_bound() const { return constraints_ && constraints_->active(); }
  double wanted_gap(int level) const { return level == finest() ? gap_wanted : coarse_gap; }
  // The share of its error that the solve of a step on `level` leaves.
  double share_left(int level, const Functional& functional) const;
  // Solves K h = force to a hundredth of the residual; h is symmetrized. Where control vertices
  // stand on pads or are held otherwise, the force has the loads' part beside it (solve_held.cpp):
  // `held` takes corrections, from that of the step before; empty loads start as those that fit
  // best. The linear solve's part of `report` is set. Returns h . K h = force . h, by which a full step would lower a
  // quadratic energy; below zero where the solve, or the loads, have found nothing of use.
  double solve(int level, const LinearizedSurface& about, Array<double>& h, Multipliers<1>& held,
               StepReport& report);

  // All that `level` has taken so far.
  StepWork work(int level) const;

  // Before each step: progress, on the finest level. Throws ErrorCode::cancelled.
  void report_progress(int level, std::size_t steps);

 private:
  PcgLimits limits(const Functional& functional) const;
  void linearize_about(const LinearizedSurface& about, const Multipliers<1>& held);
  // The springs' present weights, on all levels up to `level`.
  void set_weights(int level);
  HeldLimits held_limits(int level, const Functional& functional) const;
  // `of_held`: the forces of loads and springs.
  LevelSolve solve_held(int level, const LinearizedSurface& about, Array<double>& h,
                        Multipliers<1>& held, Array<double>& of_held, StepReport& report);

  const Stencils& stencils_;
  int base_, max_iterations_;
  double load_tolerance_;
  Monitor& monitor_;
  GridLevels grids_;
  CurvatureShared shared_;
  std::vector<std::unique_ptr<CurvatureLevel>> operators_;  // from base_ on
  QuadraticTransfers<1> transfers_;
  std::unique_ptr<Hierarchy> hierarchy_;
  Symmetrizer symmetrizer_;
  StepWork work_;
  IntervalConstraints* constraints_;  // null: nothing
};

struct SurfaceIterate {
  GaussNewtonSystem& system;
  int level = 0;
  LinearizedSurface current{};
  LinearizedSurface trial{};
  Array<double> step{};  // from `current` to the trials: along the normals, 1 number a point
  // The next step begins so near an earlier surface of this level that coarse levels, which only
  // precondition, may stay as they are.
  bool is_near_earlier = false;

  const GridLevel& grid() const { return system.grid(level); }
  CurvatureLevel& op() { return system.op(level); }
  Workers& workers() { return system.workers(); }

  // `current` about its points, and K.
  void linearize() { system.linearize(level, current); }
  void linearize(const Functional& functional) {
    current.functional = functional;
    linearize();
  }
  // The same, unless both are already.
  void begin(const Functional& functional);

  // trial <- current + length step, symmetrized, and K about it. Returns its energy.
  double try_step(double length);

  // The farthest that a step of that length takes a point.
  double movement(double length);

  // Before the next step: whether coarse levels have to be linearized anew. `last_decrement` of the
  // step before; 0: there was none, or it was rejected.
  bool needs_coarse_levels(double last_decrement);
};

}  // namespace fairing
