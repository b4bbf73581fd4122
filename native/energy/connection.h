// SPDX-License-Identifier: GPL-3.0-or-later
// The connection Laplacian on symmetric tensors in the tangent planes of a surface's points: how much a shape operator
// differs from its neighbours', after these are turned from their charts into its own. Its energy is the variation of
// curvature [Moreton and Sequin 1992].
#pragma once

#include "energy/ring_rows.h"

namespace fairing {

// Tensors have the orthonormal components of shape_rows.h, 3 numbers a point; where a point has no fit they are zero and
// count for nothing.
class Connection {
 public:
  explicit Connection(const Lattice& lattice);

  struct Surface {
    const double* x;       // 3 a point
    const double* normal;  // 3 a point; zero: no fit
    const double* axis;    // the chart's u axis in space
    const double* area;    // 1 a point
  };
  // L about a surface; writes force <- L tensor (weighted as below) and returns tensor . L tensor.
  double set(const Surface& surface, const double* tensor, Workers& workers, double* force);

  // z <- (W^-1/2 L W^-1/2 + damping) y, where W is the areas.
  template <class T>
  void apply(double damping, Workers& workers, const T* y, T* z) const;

  // The diagonal block's one number at a point, in the order of the runs: (sum of weights) / area.
  const RingRows& rows() const { return rows_; }

 private:
  RingRows rows_;  // slot 0: the sum of weights, once; others: minus the weight, and times cosine and sine
};

}  // namespace fairing
