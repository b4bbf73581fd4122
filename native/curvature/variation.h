// SPDX-License-Identifier: GPL-3.0-or-later
// From the surface of least total curvature to that of least variation of curvature [Moreton and
// Sequin 1992], by Levenberg-Marquardt steps on the same level:
//
//   (J^T (L + nu E/E_c W) J + diag(mu_i K_ii)) h = -J^T L M,
//
// E the variation and E_c the total curvature. E hardly sees long waves; the matrix of total
// curvature, which does, damps them. nu is adapted to what the steps gain, mu_i where their
// predictions fail (local_damping.h).
#pragma once

#include "curvature/steps.h"

namespace fairing {

class VariationSteps {
 public:
  // `iterate` must outlive it.
  explicit VariationSteps(SurfaceIterate& iterate);

  // From iterate.current, which must be linearized for total curvature, to the surface that at most
  // so many steps end at: at `end`, or where a few steps have left less to move than `seen_share` of
  // what all have moved; or where they began if that varies less; it is linearized for total curvature
  // again. `report` has the steps added; energy, both variations, `left` and `converged` are set. A
  // surface without any curvature stays as it is. Throws ErrorCode::cancelled.
  void run(const StepEnd& end, int most, double seen_share, CurvatureLevelReport& report);

 private:
  SurfaceIterate& iterate_;
  double nu_;  // kept from one surface to the next
};

}  // namespace fairing
