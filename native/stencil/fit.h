// SPDX-License-Identifier: GPL-3.0-or-later
// Divided differences: the least-squares quadratic of a one-ring [Kobbelt 1997a, §4], as rows for
// the thin plate and the transfers, and in closed form for the curvature of a surface.
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <span>
#include <vector>

#include "base/roundoff.h"
#include "stencil/chart.h"

namespace fairing {

// A quadratic about the chart's origin, f(u, v) - f(0) = basis(u, v) . c, in coefficients c =
//
//   (f_u, f_v, (f_uu + f_vv)/sqrt 2, (f_uu - f_vv)/sqrt 2, sqrt 2 f_uv).
//
// The last three are the Hessian in an orthonormal basis of the symmetric matrices (its trace and
// its trace-free part), so their squares add up to f_uu^2 + 2 f_uv^2 + f_vv^2.
using Coefficients = Eigen::Matrix<double, 5, 1>;
using FitRows = Eigen::Matrix<double, 5, Eigen::Dynamic>;  // one column a neighbour
constexpr double root_half = std::numbers::sqrt2 / 2;      // of that basis

Coefficients basis(const Vec2& p);

// A direction whose singular value is below this share of the largest counts as undetermined,
// because it would add only noise. The square is for normal equations.
constexpr double undetermined = 3e-3, undetermined_square = 3e-3 * 3e-3;
// A ring narrower than rounding is a line.
constexpr double thinnest_ring_square = roundoff * roundoff;

// Rows that map the differences f_j - f_0 over the chart's ring to the coefficients.
//
// Five and more neighbours: least squares. Fewer, or neighbours close to a common conic through the
// origin, do not determine a quadratic. Then a closed ring fits f_u, f_v and the trace, and takes
// the trace-free part of least norm (valence 3: none); an open ring fits f_u, f_v and takes the
// Hessian of least norm.
FitRows fit(const Chart& chart);

// rows[j] <- the last three of fit()'s coefficients for a one at neighbour j of a closed ring, in
// closed form, where fit() would cost too much. The same rules apply where the ring does not
// determine a quadratic: valence 4 gives the trace and the trace-free part of least norm, valence 3
// the trace alone. Zero for a ring without extent. Where a quadratic is determined, squared
// residuals have these weights (empty: all one).
void hessian_rows(std::span<const Vec2> ring, std::span<const double> weight,
                  std::vector<Vec3>& rows);

}  // namespace fairing
