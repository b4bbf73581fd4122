// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/roundoff.h"
#include "base/types.h"

namespace fairing {

// The tangent of 10 degrees: directions that differ by less count as one.
constexpr double collinear = 0.17632698070846498;

// From 0 to pi, for vectors of any length; 0 for a zero vector.
inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// The angle by which single precision may turn the line from a to b.
inline double turn_of_rounding(const Vec3& a, const Vec3& b) {
  return single_roundoff * std::max(a.norm(), b.norm()) / (b - a).norm();
}

}  // namespace fairing
