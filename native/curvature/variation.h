// SPDX-License-Identifier: GPL-3.0-or-later
// Moves from the surface of least total curvature to that of least variation of curvature [Moreton
// and Sequin 1992], on the same level and along its normals, so that points keep their places on
// the surface. It starts with the prolongated change on the level below.
#pragma once

#include "curvature/steps.h"

namespace fairing {

// What one level finds for the next.
struct VariationBelow {
  // The change from total curvature to variation, 3 numbers a point; or empty.
  Array<double> change{};
  // Whether the variation was zero, as on spheres: then total curvature's steps lead to the same
  // surface and cost less.
  bool vanishes = false;
};

// On the finest level: from iterate.current, which must be linearized for total curvature, to the
// end of the steps, or back to their start if that varies less; then it is linearized for total
// curvature again. Adds the steps to `report`, and sets energy, both variations, `left` and
// `converged`. A surface without curvature stays. Throws ErrorCode::cancelled.
void run_variation(SurfaceIterate& iterate, VariationBelow& below, const StopCriterion& end,
                   CurvatureLevelReport& report);

// On a coarser level: the same, but iterate.current stays; the next level starts with the result.
void prepare_variation(SurfaceIterate& iterate, VariationBelow& below, const StopCriterion& end);

}  // namespace fairing
