// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces of least total curvature, or of least variation of curvature: Gauss-Newton steps along
// the normals, level by level, from the thin plate's surface. This class decides the order; the
// methods are in its parts: start.h, steps.h, fold_repair.h, variation.h.
#pragma once

#include <optional>

#include "curvature/variation.h"
#include "grid/thickness.h"

namespace fairing {

// The surface on the finest level, and what says whether control vertices may move from there.
struct CurvedSurface {
  Array<double> points{};  // 3 numbers a point, in working coordinates; empty: no surface
  // Plain steps converged to it, and its control vertices are fixed.
  bool is_sound = false;
  double energy = 0;
  std::size_t folds = 0;
};

class GaussNewtonSolver {
 public:
  // `levels`: all from 0 on; those below `base` have no unknowns. `constraints`: those of control
  // vertices that move, and the targets of all. `pads`: the pads of control vertices while total
  // curvature is minimized, or null; some may become inactive before each level. `symmetry`:
  // that of the surface, to keep. All references must outlive the solver.
  GaussNewtonSolver(const ControlMesh& mesh, const GridLevels& grids, int base,
                    const Stencils& stencils, const Unknowns& unknowns,
                    const GaussNewtonOptions& options, IntervalConstraints constraints,
                    const Pads* pads, Symmetry symmetry, Workers& workers, Monitor& monitor);

  // Solves one level after another, from `base` on. The first starts at `plate`, the thin plate's
  // surface (3 numbers a point, in working coordinates), others at that or at one from the level
  // below, where the plate's surface is `plate_below`. The distance from the `reference` is
  // penalized. Returns the surface of the finest level, below it none. Throws ErrorCode::cancelled
  // and std::bad_alloc; the solver cannot be used afterwards.
  CurvedSurface solve_level(int level, const Array<double>& plate, const Array<double>& plate_below,
                            Reference reference, CurvatureLevelReport& report);

  // Solves the finest level again after control vertices have moved, by steps on that level only:
  // improves `surface`, which must be sound. If it is not any more, the steps have failed, and
  // another solver must solve level by level. `plate`, `reference`, throws: as for solve_level().
  void solve_moved(Symmetry symmetry, const Array<double>& plate, Reference reference,
                   CurvedSurface& surface, CurvatureLevelReport& report);

  // Whether the surface stands on point forces in spite of pads.
  bool on_points() const { return on_points_; }

 private:
  Array<double>& surface() { return iterate_.current.points; }  // of the latest level
  // Results of a level for the next one.
  struct Below {
    bool is_plain = true;  // whether plain steps led to the solution
    bool is_bubble = false;
  };
  StopCriterion end();
  // Ends the constraints: control vertices are fixed from here on. A few plain steps move the
  // surface accordingly, if they converge.
  void end_constraints(CurvatureLevelReport& report);
  // Returns whether plain steps led to the surface.
  bool solve_total_curvature(const StepStart& start, const Array<double>& plate,
                             CurvatureLevelReport& report);
  bool step(const StepStart& start, CurvatureLevelReport& report);
  // Whether the level below is a bubble and no steps, or very many, would reach its minimum. This
  // excludes the case that plain steps converged there and here.
  bool is_lost(bool is_plain) const { return below_.is_bubble && (!is_plain || varies()); }
  void vary(bool is_plain, CurvatureLevelReport& report);
  bool varies() const { return system_.options().energy == CurvatureEnergy::minimum_variation; }
  // Most total curvature that a surface of the level may have.
  double energy_bound(const CurvatureLevelReport& report);
  // Whether the steps are near a solution and have less energy than the thin plate.
  bool is_settled(const CurvatureLevelReport& report);
  // Steps from the iterate, whose control vertices have moved from those of `before`.
  bool steps_go_well(const CurvedSurface& before, CurvatureLevelReport& report);
  void keep_start_if_worse(const StepStart& start, const Array<double>& plate,
                           CurvatureLevelReport& report);
  // Resets the surface to the start or to the plate and ends the steps.
  void keep(const Array<double>& x, const StepStart& start, CurvatureLevelReport& report);
  // Of tension and the penalty.
  double energy_beside_bending(const Array<double>& x);
  void keep_bending_alone(const StepStart& start, const Array<double>& plate,
                          CurvatureLevelReport& report);
  bool is_finest() const { return iterate_.level == system_.finest(); }

  IntervalConstraints constraints_;
  const Pads* pads_;  // null: no pads
  bool on_points_ = false;
  GaussNewtonSystem system_;
  SurfaceIterate iterate_;
  std::optional<Thickness> thickness_;  // only below the finest level
  VariationBelow variation_;
  Below below_;
};

}  // namespace fairing
