// SPDX-License-Identifier: GPL-3.0-or-later
// The order in which the thin plate's levels are solved: full multigrid from the control
// polyhedron, or from an earlier surface.
#pragma once

#include <functional>
#include <vector>

#include "constraints/ball_constraints.h"
#include "thin_plate/supports.h"

namespace fairing {

// The surface of one level, which the next level's starts from.
struct PlateSurface {
  Array<double> x;  // 3 numbers a point
  PlateState state;
  Loads forces{};     // of its hats, where they say how loads change; or empty
  double energy = 0;  // 0 on the finest level
};

// The thin plate of a control mesh, in working coordinates. Builds every level once; solves as often
// as weights or control positions change. Throws what its levels throw.
class ThinPlateSolver {
 public:
  using OnPrediction = std::function<void(const double* x)>;

  // `charts` are those of the stencils. All references but to charts and options must outlive the
  // solver.
  ThinPlateSolver(const ControlMesh& mesh, const ChartMaker& charts, const Stencils& stencils,
                  Unknowns unknowns, const VertexWeights& weights, const ThinPlateOptions& options,
                  Workers& workers, Monitor& monitor);

  ThinPlateLevels& levels() { return levels_; }
  const Pads* pads() const { return supports_.pads(); }  // null without
  // Of the finest level; null without pads.
  std::shared_ptr<const Hats> hats() { return supports_.hats(levels_.top()); }
  // Likewise; null where no normal is fixed.
  std::shared_ptr<const LevelCouples> couples() { return supports_.couples(levels_.top()); }

  // From here on the smoother stays as it is, so that a surface depends on its own shape alone.
  void keep_smoother() { levels_.hierarchy().keep_smoother(); }

  // Of a surface that nothing holds yet.
  PlateState unheld() const { return supports_.unheld(); }

  // What holds control vertices that move, with its first weights on all levels.
  BallConstraints begin(ControlConstraints held);
  // One level of full multigrid: the solution from that of the level below, on the coarsest from the
  // control polyhedron. Constraints that are active choose the level's weights. `on_prediction` sees
  // the start.
  PlateSurface solve_level(int level, const PlateData& data, BallConstraints& constraints,
                           const PlateSurface& below, std::vector<LevelReport>& reports,
                           const OnPrediction& on_prediction);

  // From x, a surface of `before`, whose curves do not count, that has left this state, to that of `data`
  // on the finest level, to `tolerance`: the difference first, roughly and level by level.
  void solve_moved(const PlateData& before, const PlateData& data, double tolerance,
                   PlateState& state, Array<double>& x, std::vector<LevelReport>& reports,
                   const OnPrediction& on_prediction);

  // The finest level again, from x as it is. Of what loads carry, `rough_force` may be left at control
  // vertices even where the options ask for less. `forces`: on the level's points, 3 numbers each,
  // where the plate does not stand alone; zero on what is no unknown.
  LevelReport solve_again(const PlateData& data, double tolerance, PlateState& state,
                          Array<double>& x, double rough_force = 0,
                          std::span<const double> forces = {});

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
