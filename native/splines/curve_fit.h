// SPDX-License-Identifier: GPL-3.0-or-later
// Fits one curve to each control edge, and three inside each control triangle. The patches on both
// sides share them.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "splines/spline.h"

namespace fairing {

// Points of the lattice for a curve, including its ends. On smooth curves each has a normal of the
// surface, zero at a kink; creases and boundaries have none.
struct CurveData {
  std::vector<Vec3> points, normals;
  int edges = 1;  // number of control edges, each with the same number of steps between its points
  // Where patches end: points that the curve interpolates at t, with its tangent there if there are
  // no normals; not zero. Includes the ends that have one.
  struct Cut {
    std::size_t point;
    double t;
    Vec3 along = Vec3::Zero();
  };
  std::vector<Cut> cuts;
  bool strict = false;  // follows the lattice's line; otherwise it may move within the surface
  bool own = false;     // also has the lattice's parameters
  std::array<double, 2> corner{4, 4};  // narrowest angle to other curves at each end, radians

  bool is_uncut() const {
    return std::all_of(cuts.begin(), cuts.end(), [](const Cut& c) { return c.t == 0 || c.t == 1; });
  }
  bool halved() const { return edges == 1 && !cuts.empty(); }
  bool is_cut(std::size_t k) const {
    return std::any_of(cuts.begin(), cuts.end(), [&](const Cut& cut) { return cut.point == k; });
  }
};

struct FittedCurve {
  SplineCurve curve;
  std::vector<double> parameters;  // of the data's points: where the curve is nearest
  std::vector<Vec3> normals;       // the data's, made perpendicular to the curve
  std::vector<double> off;         // distance of each point from the curve, as in `error`
  double error = 0;  // largest distance of a point from the curve, mostly across the surface
  bool own = false;  // as in its data
};

// The component of a normal perpendicular to a unit tangent, of unit length; zero if there is none.
Vec3 across(const Vec3& normal, const Vec3& tangent);

// Interpolates the normals of the data; for smooth curves only.
Vec3 normal_at(const FittedCurve& curve, double t);

struct SpanLimits {
  int least, most;
  double tolerance;
};

// Minimizes the distances of the points from the curve. Distances along the curve have a small
// weight, those within the surface a larger one, unless the data are strict. The ends are those of
// the data, with tangents perpendicular to their normals. Doubles the number of spans until the
// error is within the tolerance.
FittedCurve fit_curve(const CurveData& data, const SpanLimits& limits);

}  // namespace fairing
