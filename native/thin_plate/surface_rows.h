// SPDX-License-Identifier: GPL-3.0-or-later
// The divided differences of one level in the metric of a surface, a set of rows for each point;
// they replace the rows by control vertex, edge and face (stencil/stencils.h). The metric of the
// control faces has a cone at each control vertex and a kink along each control edge. A surface has
// none, so the plate is close to its total curvature (docs/developers/notes/method.md).
//
// Such a plate oscillates between its fixed points, by more than the thickness of a thin wall. So
// its squared distance from a surface that does not is penalized, the reference: P, a weight for
// each point, is part of the matrix, and P reference of the right-hand side.
#pragma once

#include "sparse/ring_rows.h"
#include "stencil/stencils.h"

namespace fairing {

// The metric of a surface and the penalty on the distance from the reference.
struct SurfaceMetric {
  const double* surface;  // 3 numbers a point
  // k, one per point: the squared distance from the reference has the weight k^4 S^2 times the
  // surface's own bending at the point, with S the point's area at unit grid spacing.
  const float* penalty;
  double exponent;  // as in flatten()
};

struct SurfaceRows {
  // Those of the level, whose grid must outlive them; the weights of points are part of them. Where
  // the surface is degenerate, the rows of the control metric remain. Throws
  // FairingError(cancelled).
  SurfaceRows(const GridLevel& grid, const Stencils& stencils, const SurfaceMetric& metric,
              const Unknowns& unknowns, Workers& workers);

  RingRows rows;
  Array<float> penalty;  // P, one per point: zero if it is not an unknown
};

}  // namespace fairing
