// SPDX-License-Identifier: GPL-3.0-or-later
// One curve a control edge, and three in a control triangle, each shared by the patches on both
// sides.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "splines/spline.h"

namespace fairing {

// Points of the lattice that a curve runs through, ends included. Along smooth curves each has a
// normal of the surface, zero where it has a kink; creases and boundaries have none.
struct CurveData {
  std::vector<Vec3> points, normals;
  int edges = 1;  // control edges, each with as many steps between its points
  // Where patches end: points that are the curve's own at t, with the tangent that it has there if it
  // has no normals; not zero. Those at the ends are among them where there is one.
  struct Cut {
    std::size_t point;
    double t;
    Vec3 along = Vec3::Zero();
  };
  std::vector<Cut> cuts;
  bool strict = false;  // along the lattice's line; or anywhere near it on the surface
  bool own = false;     // and at the lattice's own parameters
  std::array<double, 2> corner{4, 4};  // the narrowest angle that it makes at each end, radians

  bool halved() const { return edges == 1 && !cuts.empty(); }
  bool is_cut(std::size_t k) const {
    return std::any_of(cuts.begin(), cuts.end(), [&](const Cut& cut) { return cut.point == k; });
  }
};

struct FittedCurve {
  SplineCurve curve;
  std::vector<double> parameters;  // of the data's points: where the curve is closest
  std::vector<Vec3> normals;       // the data's, turned to stand on the curve
  std::vector<double> off;         // how far each point is from the curve, as `error` counts it
  double error = 0;  // the farthest that a point is from the curve, across the surface mostly
  bool own = false;  // as of its data
};

// The part of a normal that stands on a unit tangent, of length one; zero where there is none.
Vec3 across(const Vec3& normal, const Vec3& tangent);

// Between those of the data; of smooth curves only.
Vec3 normal_at(const FittedCurve& curve, double t);

struct SpanLimits {
  int least, most;
  double tolerance;
};

// Minimizes the distances of the points from the curve. To slide along it costs little; to leave the
// line within the surface not much, unless the data are strict. Its ends
// are the data's, with tangents in the planes of their normals. The spans are doubled until the
// error is within the tolerance.
FittedCurve fit_curve(const CurveData& data, const SpanLimits& limits);

}  // namespace fairing
