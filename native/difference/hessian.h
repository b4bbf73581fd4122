// SPDX-License-Identifier: GPL-3.0-or-later
// The divided differences of one function at one point, where writing the rows of fit() would cost too much:
// on the stack, in closed form.
#pragma once

#include <span>
#include <vector>

#include "control_mesh/control_mesh.h"
#include "difference/fit.h"

namespace fairing {

// fit()'s threshold on singular values, on their squares.
constexpr double undetermined_square = 3e-3 * 3e-3;

// The last three of fit()'s coefficients, ((f_uu + f_vv)/sqrt 2, (f_uu - f_vv)/sqrt 2, sqrt 2 f_uv), from the
// differences f_j - f_0 over a closed ring. The same rules hold where the ring does not determine a
// quadratic: valence 4 gives the trace and the trace-free part of least norm, valence 3 the trace alone. Zero
// for a ring without any extent. Where a quadratic is determined, squared residuals count by their weights.
Vec3 fitted_hessian(std::span<const Vec2> ring, std::span<const double> difference,
                    std::span<const double> weight = {});

// The same as rows: the result is the sum of rows[j] times difference j.
void hessian_rows(std::span<const Vec2> ring, std::span<const double> weight, std::vector<Vec3>& rows);

}  // namespace fairing
