// SPDX-License-Identifier: GPL-3.0-or-later
#include "splines/spline.h"

#include <algorithm>

#include "splines/lattice.h"

namespace fairing {
namespace {

// Knot i of s spans, in units of a span.
double knot(int spans, int i) { return double(std::clamp(i - 3, 0, spans)); }

// Coefficients of powers of x, from 0 to 1 within a span.
using Cubic = std::array<double, 4>;
using Cubics = std::array<Cubic, 4>;

constexpr Cubic times(const Cubic& p, double constant, double slope) {
  Cubic out{};
  for (std::size_t k = 0; k < 4; ++k) out[k] = constant * p[k] + (k ? slope * p[k - 1] : 0);
  return out;
}

// The basis functions of a span with this number of spans before and behind it; more than two have
// no influence. De Boor's recursion.
constexpr Cubics basis_of(int before, int behind) {
  const auto low = [&](int d) { return double(std::max(1 - d, -before)); };
  const auto high = [&](int d) { return double(std::min(d, 1 + behind)); };
  Cubics b{};
  b[0][0] = 1;
  for (int d = 1; d <= 3; ++d) {
    Cubic carried{};
    for (int r = 0; r < d; ++r) {
      const double right = high(r + 1), left = low(d - r);
      const Cubic part = times(b[r], 1 / (right - left), 0);
      Cubic& own = b[r];
      own = times(part, right, -1);
      for (std::size_t k = 0; k < 4; ++k) own[k] += carried[k];
      carried = times(part, -left, 1);
    }
    b[d] = carried;
  }
  return b;
}

constexpr auto every_basis = [] {
  std::array<std::array<Cubics, 3>, 3> out{};
  for (int before = 0; before < 3; ++before)
    for (int behind = 0; behind < 3; ++behind) out[before][behind] = basis_of(before, behind);
  return out;
}();

std::vector<double> knots_of(int spans) {
  std::vector<double> knots(std::size_t(spans) + 7);
  for (std::size_t i = 0; i < knots.size(); ++i) knots[i] = knot(spans, int(i));
  return knots;
}

// Boehm's insertion of a knot; the curve is unchanged.
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
  const Cubics& cubics = every_basis[std::min(k, 2)][std::min(spans - 1 - k, 2)];
  const double local = x - k;
  CubicBasis out{k, {}, {}, {}};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& [c0, c1, c2, c3] = cubics[i];
    out.value[i] = c0 + local * (c1 + local * (c2 + local * c3));
    out.slope[i] = spans * (c1 + local * (2 * c2 + local * (3 * c3)));
    out.bend[i] = spans * spans * (2 * c2 + local * (6 * c3));
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
  return at(cubic_basis(spans_u, u), cubic_basis(spans_v, v));
}

SurfacePoint SplinePatch::at(const CubicBasis& bu, const CubicBasis& bv) const {
  SurfacePoint out{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int i = 0; i < 4; ++i) {
    const Vec3* row = &net[index(bu.first + i, bv.first)];
    Vec3 at = Vec3::Zero(), across = Vec3::Zero();
    for (std::size_t j = 0; j < 4; ++j) {
      at += bv.value[j] * row[j];
      across += bv.slope[j] * row[j];
    }
    out.at += bu.value[i] * at;
    out.along_u += bu.slope[i] * at;
    out.along_v += bu.value[i] * across;
  }
  return out;
}

double SplinePatch::curvature_across(double u, double v, const Vec3& way) const {
  const CubicBasis bu = cubic_basis(spans_u, u), bv = cubic_basis(spans_v, v);
  const SurfacePoint p = at(bu, bv);
  const Vec3 normal = p.normal();
  double uu = 0, uv = 0, vv = 0;  // the second fundamental form
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      const double height = normal.dot(net[index(bu.first + int(i), bv.first + int(j))] - p.at);
      uu += bu.bend[i] * bv.value[j] * height;
      uv += bu.slope[i] * bv.slope[j] * height;
      vv += bu.value[i] * bv.bend[j] * height;
    }
  const Vec3 across = normal.cross(way).normalized();
  const Slide step = slide_to(across, p.along_u, p.along_v);
  return step.along_u * (step.along_u * uu + 2 * step.along_v * uv) +
         step.along_v * step.along_v * vv;
}

SplineCurve refined(const SplineCurve& curve, int spans) {
  SplineCurve out = curve;
  const int parts = spans / curve.spans;
  std::vector<double> knots = knots_of(curve.spans);
  for (int i = 0; i < curve.spans; ++i)
    for (int k = 1; k < parts; ++k) insert_knot(knots, out.points, i + double(k) / parts);
  out.spans = parts * curve.spans;
  return out;
}

SplineCurve part_of(const SplineCurve& curve, int from, int to, int all) {
  const int first = curve.spans * from / all, last = curve.spans * to / all;
  SplineCurve out = curve;
  std::vector<double> knots = knots_of(curve.spans);
  for (const int end : {first, last})
    if (end > 0 && end < curve.spans)
      for (int i = 0; i < 2; ++i) insert_knot(knots, out.points, end);
  const auto begin = out.points.begin() + (first > 0 ? first + 2 : 0);
  out.spans = last - first;
  out.points = {begin, begin + control_points(out.spans)};
  return out;
}

SplineCurve reversed(SplineCurve curve) {
  std::reverse(curve.points.begin(), curve.points.end());
  return curve;
}

}  // namespace fairing
