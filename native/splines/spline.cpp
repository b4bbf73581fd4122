// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/spline.h"

#include <algorithm>

namespace fairing {
namespace {

// Knot i of s spans, in units of a span.
double knot(int spans, int i) { return double(std::clamp(i - 3, 0, spans)); }

// One over a distance of knots, 1, 2 or 3: to divide took most of the time.
double over(double distance) {
  constexpr std::array<double, 4> inverse{0, 1, 1.0 / 2, 1.0 / 3};
  return inverse[std::size_t(distance + 0.5)];
}

std::vector<double> knots_of(int spans) {
  std::vector<double> knots(std::size_t(spans) + 7);
  for (std::size_t i = 0; i < knots.size(); ++i) knots[i] = knot(spans, int(i));
  return knots;
}

// Boehm's insertion of one more knot; the curve stays.
void insert_knot(std::vector<double>& knots, std::vector<Vec3>& points, double t) {
  const auto after = std::upper_bound(knots.begin(), knots.end(), t);
  const std::size_t k = std::size_t(after - knots.begin()) - 1;
  std::vector<Vec3> out(points.size() + 1);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (i + 3 <= k)
      out[i] = points[i];
    else if (i > k)
      out[i] = points[i - 1];
    else {
      const double width = knots[i + 3] - knots[i];
      const double share = width > 0 ? (t - knots[i]) / width : 0;
      out[i] = share * points[i] + (1 - share) * points[i - 1];
    }
  }
  knots.insert(after, t);
  points = std::move(out);
}

}  // namespace

CubicBasis cubic_basis(int spans, double t) {
  const double x = std::clamp(t, 0.0, 1.0) * spans;
  const int k = std::min(int(x), spans - 1);
  std::array<double, 4> left, right, lower{}, b{1, 0, 0, 0};
  for (int d = 1; d <= 3; ++d) {
    left[std::size_t(d)] = x - knot(spans, k + 4 - d);
    right[std::size_t(d)] = knot(spans, k + 3 + d) - x;
    if (d == 3) lower = b;
    double carried = 0;
    for (int r = 0; r < d; ++r) {
      const std::size_t i = std::size_t(r);
      const double part = b[i] * over(right[i + 1] + left[std::size_t(d - r)]);
      b[i] = carried + right[i + 1] * part;
      carried = left[std::size_t(d - r)] * part;
    }
    b[std::size_t(d)] = carried;
  }
  CubicBasis out{k, b, {}};
  for (int i = 0; i < 4; ++i) {
    double slope = 0;
    const double before = knot(spans, k + i + 3) - knot(spans, k + i);
    const double behind = knot(spans, k + i + 4) - knot(spans, k + i + 1);
    if (i > 0) slope += 3 * lower[std::size_t(i - 1)] * over(before);
    if (i < 3) slope -= 3 * lower[std::size_t(i)] * over(behind);
    out.slope[std::size_t(i)] = slope * spans;
  }
  return out;
}

CurvePoint SplineCurve::at(double t) const {
  const CubicBasis b = cubic_basis(spans, t);
  CurvePoint out{Vec3::Zero(), Vec3::Zero()};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3& p = points[std::size_t(b.first) + i];
    out.at += b.value[i] * p;
    out.tangent += b.slope[i] * p;
  }
  return out;
}

SurfacePoint SplinePatch::at(double u, double v) const {
  const CubicBasis bu = cubic_basis(spans_u, u), bv = cubic_basis(spans_v, v);
  SurfacePoint out{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int i = 0; i < 4; ++i) {
    const Vec3* row = &net[index(bu.first + i, bv.first)];
    Vec3 at = Vec3::Zero(), across = Vec3::Zero();
    for (std::size_t j = 0; j < 4; ++j) {
      at += bv.value[j] * row[j];
      across += bv.slope[j] * row[j];
    }
    out.at += bu.value[std::size_t(i)] * at;
    out.along_u += bu.slope[std::size_t(i)] * at;
    out.along_v += bu.value[std::size_t(i)] * across;
  }
  return out;
}

SplineCurve refined(const SplineCurve& curve, int spans) {
  SplineCurve out = curve;
  while (out.spans < spans) {
    std::vector<double> knots = knots_of(out.spans);
    for (int i = 0; i < out.spans; ++i) insert_knot(knots, out.points, i + 0.5);
    out.spans *= 2;
  }
  return out;
}

SplineCurve half_of(const SplineCurve& curve, bool second) {
  SplineCurve out = curve;
  std::vector<double> knots = knots_of(curve.spans);
  const int half = curve.spans / 2;
  for (int i = 0; i < 2; ++i) insert_knot(knots, out.points, half);
  const auto size = std::ptrdiff_t(control_points(half));
  out.points = second ? std::vector<Vec3>(out.points.end() - size, out.points.end())
                      : std::vector<Vec3>(out.points.begin(), out.points.begin() + size);
  out.spans = half;
  return out;
}

SplineCurve reversed(SplineCurve curve) {
  std::reverse(curve.points.begin(), curve.points.end());
  return curve;
}

}  // namespace fairing
