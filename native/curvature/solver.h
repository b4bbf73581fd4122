// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces of least total curvature, or of least variation of curvature: Gauss-Newton steps along
// the normals, level by level, from the thin plate's surface. What is done in which order; how, is
// with the parts: start.h, steps.h, unfold.h, variation.h.
#pragma once

#include <optional>

#include "curvature/rough.h"
#include "curvature/variation.h"
#include "grid/thickness.h"

namespace fairing {

class GaussNewtonSolver {
 public:
  // `levels`: all from 0 on; those below `base` have no unknowns. `constraints`: what holds control
  // vertices that move, and where all of them belong. `pads`: what control vertices stand on while
  // total curvature is minimized, or null; their widths may change before each level. `mirrors`: the
  // symmetries that the surface is to keep. The references must outlive the solver.
  GaussNewtonSolver(const ControlMesh& mesh, const GridLevels& grids, int base,
                    const Stencils& stencils, const Unknowns& unknowns,
                    const GaussNewtonOptions& options, IntervalConstraints constraints,
                    const Pads* pads, Mirrors mirrors, Workers& workers, Monitor& monitor);

  // The surface of the next level, from `base` on, from `plate`, the thin plate's (3 numbers a point,
  // in working coordinates); on each but the first the level below helps to start. `finest` <- the
  // finest level's. Throws ErrorCode::cancelled, and std::bad_alloc; the solver is of no use then.
  CurvatureLevelReport solve_next_level(const Array<double>& plate, Array<double>& finest);

  // The finest level's surface again after control vertices have moved, by steps on that level
  // alone, from `surface`, which it improves. False: the steps do not go well that way, and another
  // solver has to solve level by level. It needs can_move(). Throws as solve_next_level().
  bool can_move() const;
  bool solve_moved(Mirrors mirrors, Array<double>& surface, CurvatureLevelReport& report);

  // What control vertices stand on, after the levels so far; null: on none.
  const Pads* pads() { return pads_.now(); }

 private:
  Array<double>& surface() { return iterate_.current.points; }  // of the latest level
  // What control vertices stand on: a copy of the pads given, some of which go.
  struct OwnPads {
    const Pads* given;  // null: on none
    std::optional<Pads> own{};
    std::vector<std::uint8_t> places{};  // given when it was copied

    Pads* now() { return own ? &*own : nullptr; }
    // Anew where others are given. Returns whether.
    bool take();
  };
  // A surface that the steps can go back to, and what its vertices stand on.
  struct Found {
    LinearizedSurface surface;
    CurvatureLevelReport report;
    std::optional<Pads> pads;
  };
  // What a level leaves to the next one.
  struct Below {
    Array<double> plate;   // the thin plate's surface
    bool is_plain = true;  // whether plain steps led to the solution
    bool is_bubble = false;
  };
  // The finest level's solution, as far as control vertices may move from it.
  struct Solved {
    bool is_sound = false;
    double energy = 0;
    std::size_t folds = 0;
  };
  Found found(const CurvatureLevelReport& report);
  void go_back_to(const Found& found, CurvatureLevelReport& report);

  StepEnd end();
  // The hold ends, in the system too: its control vertices stay where they are from here on. The
  // surface follows by a few plain steps, if these settle.
  void end_constraints(CurvatureLevelReport& report);
  // Returns whether plain steps led to the surface.
  bool solve_total_curvature(const StepStart& start, const Array<double>& plate,
                             CurvatureLevelReport& report);
  bool step(const StepStart& start, CurvatureLevelReport& report);
  // Whether the level below is a bubble, and where it ends would be found by no steps, or by very many:
  // unless plain ones lead there, and from there here.
  bool is_lost(bool is_plain) const { return below_.is_bubble && (!is_plain || varies()); }
  void vary(bool is_plain, CurvatureLevelReport& report);
  bool varies() const { return options_.energy == CurvatureEnergy::minimum_variation; }
  // What the surface of a level may have of total curvature.
  double energy_bound(const CurvatureLevelReport& report);
  // Whether steps of less than the thin plate's energy have come near a solution.
  bool is_settled(const CurvatureLevelReport& report);
  bool steps_go_well(Mirrors mirrors, CurvatureLevelReport& report);
  // Whether a part of the surface x lies far from the mesh.
  bool is_thrown(const Array<double>& x, const Array<double>& plate);
  void keep_start_if_worse(const StepStart& start, const Array<double>& plate,
                           CurvatureLevelReport& report);
  // Back to the start, or to the plate, with no more steps from there.
  void keep(const Array<double>& x, const StepStart& start, CurvatureLevelReport& report);
  double tension_of(const Array<double>& x);
  void leave_out_tension(const StepStart& start, const Array<double>& plate,
                         CurvatureLevelReport& report);
  bool is_finest() const { return iterate_.level == system_.finest(); }

  GaussNewtonOptions options_;
  IntervalConstraints constraints_;
  OwnPads pads_;
  GaussNewtonSystem system_;
  SurfaceIterate iterate_;
  int next_level_;
  std::vector<std::uint8_t> folded_faces_;  // of the control mesh
  Thickness thickness_;
  CurvatureSteps steps_;
  Unfolding unfolding_;
  RoughSteps rough_;
  VariationSteps variation_;
  Below below_;
  Solved solved_;
};

}  // namespace fairing
