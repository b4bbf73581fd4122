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
  // Both must outlive it.
  VariationSteps(SurfaceIterate& iterate, const GaussNewtonOptions& options);

  // From iterate.current, which must be linearized for total curvature, to the surface that the
  // steps end at, or where they began if that varies less; it is linearized for total curvature
  // again. `report` has the steps added; energy, both variations, `left` and `converged` are set. A
  // surface without any curvature stays as it is. Throws ErrorCode::cancelled.
  void run(const StepEnd& end, CurvatureLevelReport& report);

 private:
  SurfaceIterate& iterate_;
  const GaussNewtonOptions& options_;
  double nu_;  // kept from one surface to the next
};

}  // namespace fairing
