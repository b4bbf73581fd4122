// SPDX-License-Identifier: GPL-3.0-or-later
// The connection Laplacian on symmetric tensors in the tangent planes of a surface's points: the
// difference between a shape operator and its neighbours', after they are rotated from their charts
// into its own. Its energy is the variation of curvature [Moreton and Sequin 1992].
#pragma once

#include "sparse/ring_rows.h"
#include "stencil/chart.h"

namespace fairing {

struct ChartAxes {
  Vec3 normal, axis;  // the u axis in space
};

// Cosine and sine of twice the angle between two points' charts, by which a tensor rotates from the
// second to the first, from the edge `along` between them. Not finite for an edge along a normal.
Vec2 turn_between(const ChartAxes& to, const ChartAxes& from, const Vec3& along);

// Tensors have the orthonormal components of point_curvature.h, 3 numbers a point, each times the
// root of its point's area; points without an area are ignored.
class Connection {
 public:
  struct Surface {
    const double* x;       // 3 a point
    const double* normal;  // 3 a point
    const double* axis;    // the chart's u axis in space
    const double* area;    // 1 a point; zero: no fit
    // 1 a point, root of the stiffness; an edge has the product of its ends'. Null: one.
    const double* root = nullptr;
  };
  // L about a surface. `cotangents` are the weights of the edges, in the first row of each point,
  // slot by slot; L takes over their memory. Negative weights, which are rare, count as zero, so
  // that L is positive. force <- L tensor for unscaled tensors, over the root of the area.
  Connection(RingRows cotangents, const Surface& surface, const double* tensor, Workers& workers,
             double* force);
  // tensor . L tensor
  double energy() const { return energy_; }

  // z <- (L + damping) y
  void apply(double damping, Workers& workers, const double* y, double* z) const;

  // z <- the rows of the first component, which rotations keep, times y, 1 number a point.
  void apply_to_scalar(Workers& workers, const float* y, float* z) const;

  // Slot 0: the sum of the weights; the others: minus the weight, and minus the weight times cosine
  // and sine of twice the angle between the charts.
  const RingRows& rows() const { return rows_; }

  // Releases the memory for another surface's cotangents.
  RingRows release() && { return std::move(rows_); }

 private:
  RingRows rows_;
  double energy_ = 0;
};

}  // namespace fairing
