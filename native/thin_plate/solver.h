// SPDX-License-Identifier: GPL-3.0-or-later
// The order in which the thin plate's levels are solved: full multigrid from the control
// polyhedron, or from an earlier surface.
#pragma once

#include <functional>
#include <vector>

#include "constraints/ball_constraints.h"
#include "thin_plate/supports.h"

namespace fairing {

// The surface of one level, from which the next level starts.
struct PlateSurface {
  Array<double> x;  // 3 numbers a point
  PlateState state;
  Loads forces{};     // of the hats, if they predict the change of the loads; or empty
  double energy = 0;  // 0 on the finest level
};

// The thin plate of a control mesh, in working coordinates. Builds every level once; solves again
// for new weights or positions. Throws what its levels throw.
class ThinPlateSolver {
 public:
  using OnPrediction = std::function<void(const double* x)>;

  // `charts` are those of the stencils. All references except charts and options must outlive the
  // solver.
  ThinPlateSolver(const ControlMesh& mesh, const ChartMaker& charts, const Stencils& stencils,
                  Unknowns unknowns, const VertexWeights& weights, const ThinPlateOptions& options,
                  Workers& workers, Monitor& monitor);

  ThinPlateLevels& levels() { return levels_; }
  // The penalty's numbers on a level, 1 a point. Only with a penalty.
  Array<float> penalty(int level) { return levels_.penalty(level, *options_.penalty.of_points); }
  const Pads* pads() const { return supports_.pads(); }  // null without
  // The hats of the finest level; null without pads.
  std::shared_ptr<const Hats> hats() { return supports_.hats(levels_.top()); }
  // The couples of the finest level; null without fixed normals.
  std::shared_ptr<const LevelCouples> couples() { return supports_.couples(levels_.top()); }

  // Stops the smoother's adaptation, so that a surface depends on its own shape alone.
  void keep_smoother() { levels_.hierarchy().keep_smoother(); }

  // The state of a surface without loads and couples.
  PlateState unloaded() const { return supports_.unloaded(); }

  // The constraints of control vertices that move, with their first weights on all levels.
  BallConstraints begin(ControlConstraints held);
  // One level of full multigrid: solves from the solution of the level below, on the coarsest from
  // the control polyhedron. Active constraints choose the level's weights. `on_prediction` receives
  // the start.
  PlateSurface solve_level(int level, const PlateData& data, BallConstraints& constraints,
                           const PlateSurface& below, std::vector<LevelReport>& reports,
                           const OnPrediction& on_prediction);

  // From x, a surface of `before` (whose curves do not count) with this state, to the surface of
  // `data` on the finest level, to `tolerance`: the difference first, roughly and level by level.
  void solve_moved(const PlateData& before, const PlateData& data, double tolerance,
                   PlateState& state, Array<double>& x, std::vector<LevelReport>& reports,
                   const OnPrediction& on_prediction);

  // Solves the finest level again, from x. A force of `rough_force`, as a share of the loads, may
  // be left at control vertices even if the options ask for less.
  LevelReport solve_again(const PlateData& data, double tolerance, PlateState& state,
                          Array<double>& x, double rough_force = 0);

 private:
  struct Run;
  double tolerance_of(int level) const;
  void add_difference(const PlateData& before, const PlateData& data, PlateState& state,
                      Array<double>& x, std::vector<LevelReport>& reports);

  ThinPlateOptions options_;
  Monitor& monitor_;
  ThinPlateLevels levels_;
  PlateSupports supports_;
};

}  // namespace fairing
