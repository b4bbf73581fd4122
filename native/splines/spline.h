// SPDX-License-Identifier: GPL-3.0-or-later
// Cubic B-splines with uniform clamped knots on [0, 1]: s spans, s + 3 control points.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "base/types.h"

namespace fairing {

constexpr int control_points(int spans) { return spans + 3; }

// The four basis functions that are nonzero at t, with first and second derivatives.
struct CubicBasis {
  int first;
  std::array<double, 4> value, slope, bend;
};
CubicBasis cubic_basis(int spans, double t);

struct CurvePoint {
  Vec3 at, tangent;
};

struct SplineCurve {
  int spans = 1;
  std::vector<Vec3> points;

  CurvePoint at(double t) const;
};

struct SurfacePoint {
  Vec3 at, along_u, along_v;

  Vec3 normal() const { return along_u.cross(along_v).normalized(); }
};

// Control point (i, j), i along u, is net[i * control_points(spans_v) + j].
struct SplinePatch {
  int spans_u = 1, spans_v = 1;
  std::vector<Vec3> net;

  std::size_t index(int i, int j) const {
    return std::size_t(i) * std::size_t(control_points(spans_v)) + std::size_t(j);
  }
  SurfacePoint at(double u, double v) const;
  SurfacePoint at(const CubicBasis& u, const CubicBasis& v) const;
  // The normal curvature perpendicular to `way`, positive towards the normal.
  double curvature_across(double u, double v, const Vec3& way) const;
};

// The same curve with `spans` spans, a multiple of its own; exact.
SplineCurve refined(const SplineCurve& curve, int spans);
// The part on [from / all, to / all], where both are knots; exact.
SplineCurve part_of(const SplineCurve& curve, int from, int to, int all);
SplineCurve reversed(SplineCurve curve);

}  // namespace fairing
