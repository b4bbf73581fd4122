// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of a mesh at a border vertex: a polynomial fitted to the points around.
#pragma once

#include <span>
#include <vector>

#include "base/types.h"

namespace fairing {

struct BorderFitOptions {
  int degree;        // at least 2
  double soft;       // squared distance, of the farthest's, at which a point's weight is halved
  double level;      // slope below which the frame is settled
  double full_rank;  // least sine of the angle between a term's column and those before
};

struct BorderFit {
  Vec3 normal, inward;
  Eigen::Matrix3d bend;  // second fundamental form
  // (n, 2): changes of the slope and of the curvature across the border per move of each point along
  // the normal.
  Eigen::MatrixX2d rows;
};

// `away`: n points from the vertex; `along`: the border's unit tangent; `up`: near the normal.
BorderFit fit_border(std::span<const Vec3> away, Vec3 along, Vec3 up,
                     const BorderFitOptions& options);

}  // namespace fairing
