// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces of meshes so rough that plain steps on pads run wild: first on point forces, where steps go
// down an energy, then on to the pads that the surface can stand on.
#pragma once

#include "curvature/unfold.h"

namespace fairing {

class RoughSteps {
 public:
  // All must outlive it.
  RoughSteps(SurfaceIterate& iterate, Unfolding& unfolding, CurvatureSteps& steps)
      : it_(iterate), unfolding_(unfolding), steps_(steps) {}

  // From `start` to the least total curvature on point forces, and on the finest level on to those
  // of `pads`, where there are any, that the surface can stand on; the others go. All go where folds
  // had to be filled (measured: of eleven such surfaces nine folded again on pads, bent more, or
  // were not as near to a solution). `report` begins anew with it. Throws ErrorCode::cancelled.
  void run(Pads* pads, const StepStart& start, CurvatureLevelReport& report);

 private:
  void run_on_points(const StepStart& start, CurvatureLevelReport& report);
  void go_onto(Pads& pads, const StepStart& start, CurvatureLevelReport& report);
  void leave_turned(Pads& pads);
  void leave_all(Pads& pads);
  void leave(Pads& pads, std::size_t v);
  // Plain steps to the end, where these make no folds.
  void polish(CurvatureLevelReport& report);

  SurfaceIterate& it_;
  Unfolding& unfolding_;
  CurvatureSteps& steps_;
};

}  // namespace fairing
