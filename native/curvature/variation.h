// SPDX-License-Identifier: GPL-3.0-or-later
// From the surface of least total curvature to that of least variation of curvature [Moreton and
// Sequin 1992], on the same level and along its normals, so that points keep their places on the
// surface. The level below tells where to begin: its own change from the one to the other, prolonged.
#pragma once

#include "curvature/steps.h"

namespace fairing {

class VariationSteps {
 public:
  VariationSteps(SurfaceIterate& iterate, CurvatureSteps& steps)
      : iterate_(iterate), steps_(steps) {}

  // On the finest level: from iterate.current, which must be linearized for total curvature, to the
  // surface that the steps end at, or where they began if that varies less; it is linearized for
  // total curvature again. `report` has the steps added; energy, both variations, `left` and
  // `converged` are set. A surface without any curvature stays as it is. Throws
  // ErrorCode::cancelled.
  void run(const StepEnd& end, CurvatureLevelReport& report);

  // On a level below: the same, but iterate.current stays as it is. The next level begins with what
  // has been found.
  void look_ahead(const StepEnd& end);

  // Whether nothing varied on a level below, as on spheres: total curvature's steps lead there too,
  // and are the cheaper ones.
  bool vanishes() const { return vanishes_; }

  // The next level is to begin with nothing but its own surface.
  void forget() { change_.clear(); }

 private:
  bool begin_with_change();
  void go_to(const Array<double>& points);
  bool steps_fall(double most, const StepEnd& end, CurvatureLevelReport& report);
  bool vary(const Array<double>& start, const StepEnd& end, CurvatureLevelReport& report);

  SurfaceIterate& iterate_;
  CurvatureSteps& steps_;
  // On the level before: from total curvature to variation, 3 numbers a point; empty: not known.
  Array<double> change_;
  bool vanishes_ = false;
};

}  // namespace fairing
