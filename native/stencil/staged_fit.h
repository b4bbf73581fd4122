// SPDX-License-Identifier: GPL-3.0-or-later
// What fit() (stencil/fit.h) does with rings that do not determine a quadratic: two stages.
#pragma once

#include "stencil/fit.h"

namespace fairing {

// The rows of fit() from the basis at the neighbours (one row each, five columns): first the
// `leading` columns alone, by least squares; then, from what they leave over, the others with least
// norm.
FitRows staged_fit(const Eigen::MatrixXd& basis, int leading);

// The last three coefficients of the same fit with three leading columns, from differences over a
// closed ring, by normal equations. Zero for a ring without any extent.
Vec3 staged_hessian(std::span<const Vec2> ring, std::span<const double> difference);

}  // namespace fairing
