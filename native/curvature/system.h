// SPDX-License-Identifier: GPL-3.0-or-later
// The Gauss-Newton systems K h = f of all levels about one surface, with linear solves: conjugate
// gradients with V-cycles, whose transfers are those of the thin plate. Also the surface with its
// linearization and a trial surface, on which all methods work.
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

struct LinearizedSurface {
  Array<double> points;  // 3 numbers a point, in working coordinates
  Functional functional;
  Linearization linearization;  // of the functional about `points`
  double energy = 0;
  int version = 0;      // number of its linearization on its level: K is about the latest one
  Multipliers<1> held;  // multipliers of its control vertices; empty: unknown
};

// Below this decrement coarse levels, their factor and the eigenvalues are accurate enough to keep.
constexpr double settling_decrement = 0.1;

// Tolerance of solves whose loads or active intervals are about to change, relative to the error.
constexpr double inexact = 0.1;

class GaussNewtonSystem {
 public:
  // `levels`: all from 0 on; those below `base` have no unknowns that are worth a solve.
  // `constraints`: those of control vertices that move, along the normals, while total curvature is
  // minimized, until fix_control_vertices(); or null. All references must outlive the system.
  GaussNewtonSystem(const ControlMesh& mesh, const GridLevels& grids, int base,
                    const Stencils& stencils, const Unknowns& unknowns,
                    const GaussNewtonOptions& options, IntervalConstraints* constraints,
                    Symmetry symmetry, Workers& workers, Monitor& monitor);
  ~GaussNewtonSystem();
  GaussNewtonSystem(const GaussNewtonSystem&) = delete;  // its parts refer to each other

  int base() const { return base_; }
  int finest() const { return int(grids_.size()) - 1; }
  const GaussNewtonOptions& options() const { return options_; }
  const ControlMesh& mesh() const { return shared_.mesh; }
  const GridLevel& grid(int level) const { return *grids_[level]; }
  CurvatureLevel& op(int level) const { return *operators_[level - base_]; }
  const Stencils& stencils() const { return stencils_; }
  CurvatureShared& shared() { return shared_; }
  Workers& workers() { return shared_.workers; }

  void set_symmetry(Symmetry symmetry) { symmetry_ = std::move(symmetry); }
  // Makes a surface of `level` symmetric; points that are not unknowns stay.
  void symmetrize(int level, Array<double>& x) {
    fairing::symmetrize(grid(level), symmetry_, shared_.unknowns, workers(), x.data());
  }

  // Linearizes about the surface's points, which sets K of `level`.
  void linearize(int level, LinearizedSurface& surface);
  // Penalizes the distance from a reference on `level` from here on, by weights from the bending of
  // the surface that was linearized last, for total curvature; empty: does nothing.
  void penalize(int level, Reference reference, LinearizedSurface& surface);
  // Linearizes the levels below `level` about the injected surface of that level.
  void linearize_below(int level, const LinearizedSurface& about);

  // Adds mu_i K_ii to the diagonal of `level`, and the injected mu on the levels below; empty:
  // nothing. `share`: as for CurvatureLevel.
  void set_damping(int level, const Array<float>& mu, double share);

  // Ends the constraints: control vertices that are not among `unknowns` are fixed. Linearizes
  // `level` and those below about `surface`, with factors for these unknowns.
  void fix_control_vertices(Unknowns unknowns, int level, LinearizedSurface& surface);
  // Whether control vertices have tolerances; then the duality gap wanted on a level.
  bool is_bound() const { return constraints_ && constraints_->active(); }
  double wanted_gap(int level) const { return level == finest() ? gap_wanted : coarse_gap; }
  // Share of its error that the solve of a step on `level` leaves.
  double error_reduction(int level, const Functional& functional) const;
  // Solves K h = force to a hundredth of the residual and symmetrizes h. With pads or other
  // constraints the loads add to the force (solve_held.cpp): `held` is corrected from that of the
  // previous step; empty loads start at a least-squares fit. Sets the linear solve's part of
  // `report`. Returns h . K h = force . h, by which a full step would lower a quadratic energy; it
  // is negative if the solve or the loads have failed.
  double solve(int level, const LinearizedSurface& about, Array<double>& h, Multipliers<1>& held,
               StepReport& report);

  // All work on `level` so far.
  StepWork work(int level) const;

  // Call it before each step; reports progress on the finest level. Throws ErrorCode::cancelled.
  void report_progress(int level, std::size_t steps);

 private:
  PcgLimits limits(int level, const Functional& functional) const;
  void linearize_about(const LinearizedSurface& about, const Multipliers<1>& held);
  // Sets the present weights of the springs on all levels up to `level`.
  void set_weights(int level);
  HeldLimits held_limits(int level, const Functional& functional) const;
  // constraint_force <- the forces of loads and springs.
  LevelSolve solve_held(int level, const LinearizedSurface& about, Array<double>& h,
                        Multipliers<1>& held, Array<double>& constraint_force, StepReport& report);

  const Stencils& stencils_;
  int base_;
  GaussNewtonOptions options_;
  Monitor& monitor_;
  GridLevels grids_;
  CurvatureShared shared_;
  std::vector<std::unique_ptr<CurvatureLevel>> operators_;  // from base_ on
  QuadraticTransfers<1> transfers_;
  std::unique_ptr<Hierarchy> hierarchy_;
  Symmetry symmetry_;
  StepWork work_;
  IntervalConstraints* constraints_;  // null: none
};

struct SurfaceIterate {
  GaussNewtonSystem& system;
  const ControlConstraints& constraints;
  std::vector<std::uint8_t> folded_faces;  // of the control mesh, where its surface may fold too
  int level = 0;
  LinearizedSurface current{};
  LinearizedSurface trial{};
  Array<double> step{};  // from `current` to the trials along the normals, 1 number a point
  // The next step starts so near an earlier surface of this level that coarse levels, which only
  // precondition, are kept.
  bool is_near_earlier = false;

  const GridLevel& grid() const { return system.grid(level); }
  CurvatureLevel& op() { return system.op(level); }
  Workers& workers() const { return system.workers(); }

  // Linearizes about `current`, which sets K.
  void linearize() { system.linearize(level, current); }
  void linearize(const Functional& functional) {
    current.functional = functional;
    linearize();
  }
  // The same, unless K is already that.
  void ensure_linearized(const Functional& functional);

  // trial <- current + length step, symmetrized; linearizes about it. Returns its energy.
  double try_step(double length);

  // Largest move of a point by a step of that length.
  double movement(double length);

  // Call it before each step. Returns whether to linearize coarse levels again. `last_decrement`:
  // of the previous step; 0 if there was none, or it was rejected.
  bool needs_coarse_levels(double last_decrement);
};

}  // namespace fairing
