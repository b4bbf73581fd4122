// SPDX-License-Identifier: GPL-3.0-or-later
// fit() (stencil/fit.h) for rings that do not determine a quadratic: two stages.
#pragma once

#include "stencil/fit.h"

namespace fairing {

// The rows of fit() over a ring: first the `leading` coefficients alone, by least squares; then,
// from their remainder, the others with least norm. Zero for a ring without extent.
FitRows staged_fit(std::span<const Vec2> ring, int leading);

}  // namespace fairing
