// SPDX-License-Identifier: GPL-3.0-or-later
// How the second fundamental form at a point answers to displacements along the normals: the rows of the Gauss-Newton
// steps.
#pragma once

#include "energy/point_curvature.h"

namespace fairing {

// Which functional the rows serve. Displacing the surface by h n turns its metric by -2 h M, so that beside the
// Hessian of h there is a term of h itself:
//
//   total_curvature:    h (M^2 - tr(M) M / 2), with the change of area in it: the variation of |M|^2 dA
//   minimum_variation:  h M^2, the variation of the shape operator alone
enum class CurvatureEnergy { total_curvature, minimum_variation };

// M and its rows in the orthonormal components ((M_uu + M_vv)/sqrt 2, (M_uu - M_vv)/sqrt 2, sqrt 2 M_uv).
struct ShapeRows {
  PointCurvature point;
  SurfaceChart chart;
  Vec3 shape = Vec3::Zero();  // M
  std::vector<Vec3> row;      // times the displacement of neighbour j
  Vec3 own = Vec3::Zero();    // times that of the point
};

// The trace's row is the cotangent Laplacian over the point's area, which is symmetric once it is weighted with the
// areas; the trace-free rows are those of the least-squares fit. No area: nothing else is set.
void linearize(const SurfaceRing& ring, CurvatureEnergy energy, ShapeRows& out);

// The chart's u axis in space. Charts scale their angles to a full turn, so that no neighbour's direction agrees with the
// chart's but by chance; the axis is where all of them agree best, whichever neighbour the chart started from.
Vec3 chart_axis(const Vec3& normal, std::span<const Vec3> ring, const SurfaceChart& chart);

}  // namespace fairing
