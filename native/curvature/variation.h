// SPDX-License-Identifier: GPL-3.0-or-later
// Moves from the surface of least total curvature to that of least variation of curvature [Moreton
// and Sequin 1992], on the same level and along its normals, so that points keep their places on
// the surface. It starts with the prolongated change on the level below.
#pragma once

#include "curvature/steps.h"

namespace fairing {

class VariationSteps {
 public:
  VariationSteps(SurfaceIterate& iterate, CurvatureSteps& steps)
      : iterate_(iterate), steps_(steps) {}

  // On the finest level: from iterate.current, which must be linearized for total curvature, to the
  // end of the steps, or back to their start if that varies less; then it is linearized for total
  // curvature again. Adds the steps to `report`, and sets energy, both variations, `left` and
  // `converged`. A surface without curvature stays. Throws ErrorCode::cancelled.
  void run(const StopCriterion& end, CurvatureLevelReport& report);

  // On a coarser level: the same, but iterate.current stays; the next level starts with the result.
  void prepare_next_level(const StopCriterion& end);

  // Whether the variation was zero on a coarser level, as on spheres: then total curvature's steps
  // lead to the same surface and cost less.
  bool vanishes() const { return vanishes_; }

  // The next level starts with its own surface only.
  void forget() { change_.clear(); }

 private:
  bool begin_with_change();
  void go_to(const Array<double>& points);
  bool steps_fall(double most, const StopCriterion& end, CurvatureLevelReport& report);
  bool vary(const Array<double>& start, const StopCriterion& end, CurvatureLevelReport& report);

  SurfaceIterate& iterate_;
  CurvatureSteps& steps_;
  // The previous level's change from total curvature to variation, 3 numbers a point; or empty.
  Array<double> change_;
  bool vanishes_ = false;
};

}  // namespace fairing
