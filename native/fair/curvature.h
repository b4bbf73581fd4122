// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces of least total curvature or least variation of curvature: Gauss-Newton steps along the normals, level by
// level, from the thin plate's surface.
#pragma once

#include <memory>
#include <vector>

#include "energy/curvature_level.h"
#include "fair/control_hold.h"
#include "fair/folds.h"
#include "fair/local_damping.h"
#include "fair/options.h"
#include "fair/report.h"
#include "fair/symmetry.h"
#include "solver/anderson.h"
#include "solver/hierarchy.h"

namespace fairing {

class CurvatureSystem {
 public:
  // `lattices` are all levels from 0 on; levels below `base` have no unknowns. `epsilon` in working units: how far
  // interpolated control vertices are let go at the end. `mirrors`: what symmetries the surface is to keep.
  CurvatureSystem(const ControlMesh& mesh, std::vector<const Lattice*> lattices, int base,
                  const Stencils& stencils, const Unknowns& unknowns, const FairOptions& options,
                  ControlHold hold, double epsilon, Mirrors mirrors, Workers& workers, Monitor& monitor);
  ~CurvatureSystem();

  // The surface of a level, from `plate`, the thin plate's. Levels have to come in order; on each but the first the
  // level below helps to start.
  CurvatureLevelReport solve_level(int level, const Array<double>& plate);

  // The finest level's surface again after control vertices have moved, by steps on that level alone, from the one before:
  // leave_plate() takes the thin plate's surface of before off it, solve_moved() puts the present one in its place. False:
  // it does not go well that way, and another system has to solve level by level. Both need can_move().
  bool can_move() const;
  void leave_plate(const Array<double>& plate);
  bool solve_moved(const Array<double>& plate, Mirrors mirrors, CurvatureLevelReport& report);

  // The latest level's surface.
  Array<double>& surface() { return surface_; }

 private:
  const Lattice& lattice(int level) const { return *lattices_[std::size_t(level)]; }
  CurvatureLevel& op(int level) { return *operators_[std::size_t(level - base_)]; }
  void symmetrize(int level, Array<double>& x);
  void take_plate(int level, const Array<double>& plate);
  void choose_start(int level, const Array<double>& plate, CurvatureLevelReport& report);
  // How steps are gone. Plain ones, full and unchecked, pass through humps of the discrete energy where checked and damped
  // ones are trapped; damped ones hold where a surface is crumpled and plain ones run wild.
  enum class Mode { undecided, plain, damped };
  bool settled(const CurvatureLevelReport& report) const;

  struct Found {
    Array<double> surface;
    CurvatureLevel::Surface here;
    double energy;
  };
  Found found() const { return {surface_, here_, energy_}; }
  void restore(const Found& found) {
    surface_ = found.surface;
    here_ = found.here;
    energy_ = found.energy;
  }
  // Plain steps have to come to this decrement in time; on coarse levels they end there.
  static constexpr double plain_decrement = 1e-3;
  static constexpr int short_patience = 6;
  static constexpr double least_length = 1.0 / 8;
  static constexpr double damped_decrement = 3e-2;  // where damped steps end
  static constexpr int most_rejections = 4;
  static constexpr double flat = 1e-16;               // an energy that is rounding
  static constexpr double first_damping_share = 0.1;  // of variation's steps, where nothing is known

  // Near the end the surface hardly changes: what only preconditions stays as it is.
  static constexpr double nearly_there = 0.1;  // decrement
  static bool is_fresh(double last_decrement) {
    return !(last_decrement > 0 && last_decrement < nearly_there);
  }

  struct Enough {
    double decrement = 0;  // zero: what is left to move counts
    double movement = 0;
  };
  void minimize(int level, Mode mode, const Enough& enough, int patience, CurvatureLevelReport& report);
  void go_steps(int level, LocalDamping* damping, const Enough& enough, int most, int patience,
                CurvatureLevelReport& report);
  void fall_back(int level, const Array<double>& plate, CurvatureLevelReport& report);
  Folds find_folds_of(int level);
  void grow_marks(int level, int by, Array<float>& marks);
  void unfold(int level, const Array<double>& start, const CurvatureLevelReport& fresh,
              CurvatureLevelReport& report);
  void refill(int level, const Array<float>& marks);
  bool leave_bursts_out(int level, const CurvatureLevel::Surface& before, double most,
                        Array<float>& left_out);
  void adapt_hold(int level);
  void finish_hold(int level, CurvatureLevelReport& report);
  void release(int level, CurvatureLevelReport& report);
  void follow(int level, CurvatureLevelReport& report);
  void polish(int level, CurvatureLevelReport& report);
  void vary(int level, CurvatureLevelReport& report);
  void report_progress(int level, const CurvatureLevelReport& report);
  void linearize_below(int level);
  void damp(int level, const Array<float>& mu);
  double solve_step(int level, StepReport& report, bool fresh);
  double try_step(int level, double length);
  bool advance(int level, StepReport& step, LocalDamping* damping, int rejections, int steps);

  const ControlMesh& mesh_;
  std::vector<const Lattice*> lattices_;
  int base_;
  const Stencils& stencils_;
  const FairOptions& options_;
  Workers& workers_;
  Monitor& monitor_;
  ControlHold hold_;
  double epsilon_;
  Mirrors mirrors_;
  CurvatureShared shared_;
  std::vector<std::unique_ptr<CurvatureLevel>> operators_;  // from base_ on
  std::vector<std::unique_ptr<LevelTransfer>> transfers_;
  Hierarchy hierarchy_;
  Exchange<double, 3> exchange_;
  Mode mode_ = Mode::undecided;
  std::vector<std::uint8_t> folded_faces_;  // of the control mesh
  Array<double> surface_, trial_, step_;
  double energy_ = 0;  // of surface_, as the next two
  CurvatureLevel::Surface here_, there_;
  bool is_linearized_ = false;  // the level's operator about surface_, with here_ and energy_
  Array<float> predicted_;
  Anderson anderson_;
  Array<double> plate_below_;  // the thin plate's surface on the level before
  double damping_share_ = first_damping_share;
  // Of the finest level's surface.
  bool sound_ = false;
  double found_energy_ = 0;
  std::size_t found_folds_ = 0;
  bool is_near_ = false;  // the next step begins near that surface: its coarse levels will do
};

}  // namespace fairing
