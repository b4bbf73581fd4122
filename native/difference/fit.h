// SPDX-License-Identifier: GPL-3.0-or-later
// Divided differences: the least-squares quadratic of a one-ring [Kobbelt 1997a, §4].
#pragma once

#include <Eigen/Core>

#include "chart/chart.h"

namespace fairing {

// A quadratic about the chart's origin, f(u, v) - f(0) = basis(u, v) . c, in coefficients c =
//
//   (f_u, f_v, (f_uu + f_vv)/sqrt 2, (f_uu - f_vv)/sqrt 2, sqrt 2 f_uv).
//
// The last three are the Hessian in an orthonormal basis of the symmetric matrices (its trace and its trace-free
// part), so their squares add up to f_uu^2 + 2 f_uv^2 + f_vv^2.
using Coefficients = Eigen::Matrix<double, 5, 1>;
using FitRows = Eigen::Matrix<double, 5, Eigen::Dynamic>;  // one column a neighbour

Coefficients basis(const Vec2& p);

// Rows that turn the differences f_j - f_0 over the chart's ring into the coefficients.
//
// Five and more neighbours: least squares. Fewer, or neighbours too near a common conic through the origin, do not
// determine a quadratic: a closed ring then fits f_u, f_v and the trace, and takes the trace-free part of least norm
// (valence 3: none); an open ring fits f_u, f_v and takes the Hessian of least norm.
FitRows fit(const Chart& chart);

}  // namespace fairing
