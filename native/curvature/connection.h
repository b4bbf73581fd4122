// SPDX-License-Identifier: GPL-3.0-or-later
// The connection Laplacian on symmetric tensors in the tangent planes of a surface's points: how
// much a shape operator differs from its neighbours', once these are turned from their charts into
// its own. Its energy is the variation of curvature [Moreton and Sequin 1992].
#pragma once

#include "curvature/ring_jacobian.h"
#include "stencil/chart.h"

namespace fairing {

// Tensors have the orthonormal components of point_curvature.h, 3 numbers a point, each scaled with
// the root of its point's area; points without an area count for nothing.
class Connection {
 public:
  explicit Connection(const GridLevel& grid) : rows_(grid) {}

  // The edges' cotangent weights, slot by slot; whoever walks the rings writes them.
  RingJacobian& weights() { return rows_; }

  struct Surface {
    const double* x;       // 3 a point
    const double* normal;  // 3 a point
    const double* axis;    // the chart's u axis in space
    const double* area;    // 1 a point; zero: no fit
  };
  // L about a surface whose weights() are written; they are used up. Negative weights count as
  // zero: there are few, and without them L is positive. force <- L tensor for unscaled tensors,
  // over the root of the area; returns tensor . L tensor.
  double set(const Surface& surface, const double* tensor, Workers& workers, double* force);

  // z <- (L + damping) y
  void apply(double damping, Workers& workers, const double* y, double* z) const;

  // z <- the rows of the first component, which no turn of a chart changes, on y, 1 number a point.
  void apply_to_scalar(Workers& workers, const float* y, float* z) const;

  // Slot 0: the sum of weights; the others: minus the weight, and that times cosine and sine of
  // twice the angle between the charts.
  const RingJacobian& rows() const { return rows_; }

 private:
  RingJacobian rows_;
};

}  // namespace fairing
