// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "base/types.h"

namespace fairing {

// The tangent of 10 degrees: directions that differ by less count as one.
constexpr double collinear = 0.17632698070846498;

// From 0 to pi, for vectors of any length; 0 for a zero vector.
inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace fairing
