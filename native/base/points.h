// SPDX-License-Identifier: GPL-3.0-or-later
// Points in arrays of coordinates, 3 numbers each.
#pragma once

#include <algorithm>
#include <iterator>
#include <span>

#include "base/types.h"

namespace fairing {

template <class Array>
Vec3 point_at(const Array& coordinates, std::int64_t p) {
  return Eigen::Map<const Vec3>(std::data(coordinates) + 3 * p);
}
inline Vec3 point_at(const double* coordinates, std::int64_t p) {
  return Eigen::Map<const Vec3>(coordinates + 3 * p);
}

// The coordinates of points, one after another.
inline std::span<const double> flat(std::span<const Vec3> points) {
  return {points.empty() ? nullptr : points.data()->data(), 3 * points.size()};
}

// Returns the place of the next point.
inline double* put_point(const Vec3& point, double* to) { return std::copy_n(point.data(), 3, to); }

// Unit length; zero for the zero vector.
inline Vec3 unit_or_zero(const Vec3& v) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

}  // namespace fairing
