// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/point_curvature.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "stencil/angle.h"
#include "stencil/fit.h"

namespace fairing {
namespace {

// A neighbour with the reciprocal of its squared distance.
struct Neighbour {
  Vec3 p;
  double square, inverse;
  explicit Neighbour(const Vec3& offset)
      : p(offset), square(offset.squaredNorm()), inverse(1 / square) {}
};

// What two neighbours span at p_i.
struct Wedge {
  Vec3 cross;
  double sine, cosine;  // times both lengths
  Wedge(const Neighbour& a, const Neighbour& b)
      : cross(a.p.cross(b.p)), sine(cross.norm()), cosine(a.p.dot(b.p)) {}
};

// Sums over the triangles between the point and its ring.
struct Fan {
  Vec3 normal = Vec3::Zero();
  Vec3 laplacian = Vec3::Zero();  // half cotangents times offsets
  double circumcentric = 0, barycentric = 0;
  std::vector<double>& cotangent;

  explicit Fan(std::vector<double>& c) : cotangent(c) {}

  void add(const Neighbour& a, std::size_t a_place, const Neighbour& b, std::size_t b_place,
           const Wedge& wedge, double weight) {
    if (!(wedge.sine * wedge.sine > thinnest_ring_square * a.square * b.square)) return;
    normal += (weight * a.inverse * b.inverse) * wedge.cross;
    const double scale = 0.5 * weight / wedge.sine;
    const double at_a = scale * (a.square - wedge.cosine), at_b = scale * (b.square - wedge.cosine);
    laplacian += at_b * a.p + at_a * b.p;
    cotangent[a_place] += at_b;
    cotangent[b_place] += at_a;
    circumcentric += 0.25 * (at_b * a.square + at_a * b.square);
    barycentric += weight / 6 * wedge.sine;
  }
};

// The product of two turns.
Vec2 turned(const Vec2& a, const Vec2& b) {
  return {a.x() * b.x() - a.y() * b.y(), a.x() * b.y() + a.y() * b.x()};
}

// On entry chart[j] is the unit vector of the angle between neighbours j - 1 and j, and angle[j]
// its size, for j > 0. `total` angles become a full turn.
void lay_out(std::span<Vec2> chart, std::span<const double> angle, double total,
             const SurfaceRing& ring) {
  const double excess = full_turn / total - 1;
  Vec2 direction(1, 0), correction;
  chart[0] = direction * ring.offset[0].norm();
  for (std::size_t j = 1; j < chart.size(); ++j) {
    small_turn(excess * angle[j], correction.x(), correction.y());
    direction = turned(direction, turned(chart[j], correction));
    chart[j] = direction * ring.offset[j].norm();
  }
}

// Of an open ring, which few points have.
Vec3 open_hessian(const SurfaceChart& chart) {
  const FitRows rows = fit({chart.ring, 0, false});
  Vec3 hessian = Vec3::Zero();
  for (std::size_t j = 0; j < chart.height.size(); ++j)
    hessian += chart.height[j] * rows.col(Eigen::Index(j)).tail<3>();
  return hessian;
}

// Sums over the ring; false where two points coincide. `angle`, if wanted: into chart.ring and
// chart.height, for lay_out(), and their total.
template <bool angles>
bool sum_up(const SurfaceRing& ring, SurfaceChart& chart, Fan& fan, double& total) {
  const std::size_t size = ring.offset.size();
  if (size == 0) return false;
  chart.ring.resize(size);
  chart.height.resize(size);
  chart.cotangent.assign(size, 0.0);
  const Neighbour first(ring.offset[0]);
  Neighbour a = first;
  if (!(a.square > ring_nearest)) return false;
  const std::size_t end = ring.closed ? size : size - 1;
  for (std::size_t j = 1; j <= end; ++j) {
    const std::size_t here = j < size ? j : 0;
    const Neighbour b = here ? Neighbour(ring.offset[j]) : first;
    if (!(b.square > ring_nearest)) return false;
    const Wedge wedge(a, b);
    fan.add(a, j - 1, b, here, wedge, ring.far[j - 1] || ring.far[here] ? 0.5 : 1.0);
    if (ring.far[here]) {
      const std::size_t next = here + 1 < size ? here + 1 : 0;
      const Neighbour c(ring.offset[next]);
      if (!(c.square > ring_nearest)) return false;
      fan.add(a, j - 1, c, next, Wedge(a, c), 0.5);
    }
    if constexpr (angles) {
      const double inverse = std::sqrt(a.inverse * b.inverse);
      chart.ring[here] = Vec2(wedge.cosine * inverse, wedge.sine * inverse);
      chart.height[here] = angle_of(chart.ring[here].y(), chart.ring[here].x(), 1);
      total += chart.height[here];
    }
    a = b;
  }
  return true;
}

// Of a ring whose sums give no curvature: none where it has shrunk to nothing, but infinite where
// it has burst, lest that be what takes the least energy.
PointCurvature without_shape(const SurfaceRing& ring) {
  for (const Vec3& offset : ring.offset)
    if (!(offset.squaredNorm() < ring_farthest)) return PointCurvature::infinite();
  return {};
}

void lift_cotangents(const SurfaceRing& ring, SurfaceChart& chart, Fan& fan) {
  for (std::size_t j = 0; j < ring.offset.size(); ++j) {
    double& cotangent = chart.cotangent[j];
    const double extra = std::max(ring.own_lift, ring.lift[j]) * std::max(-cotangent, 0.0);
    cotangent += extra;
    fan.laplacian += extra * ring.offset[j];
    fan.circumcentric += 0.25 * extra * ring.offset[j].squaredNorm();
  }
}

}  // namespace

float area_lift(const SurfaceRing& ring, SurfaceChart& chart) {
  Fan fan(chart.cotangent);
  double total = 0;
  if (!ring.closed || !sum_up<false>(ring, chart, fan, total)) return 0;
  const double missing = least_area_share * fan.barycentric - fan.circumcentric;
  if (!(missing > 0)) return 0;
  double negative = 0;
  for (std::size_t j = 0; j < ring.offset.size(); ++j)
    negative += 0.25 * std::max(-chart.cotangent[j], 0.0) * ring.offset[j].squaredNorm();
  return negative > missing ? float(missing / negative) : 1.0f;
}

PointCurvature point_curvature(const SurfaceRing& ring, SurfaceChart& chart) {
  const std::size_t size = ring.offset.size();
  Fan fan(chart.cotangent);
  double total = 0;
  if (!sum_up<true>(ring, chart, fan, total)) return without_shape(ring);
  chart.rest.resize(size);
  chart.weight.resize(size);
  if (!ring.lift.empty()) lift_cotangents(ring, chart, fan);
  PointCurvature out;
  const double length = fan.normal.norm();
  if (!(length > 0 && total > 0 && std::isfinite(length))) return without_shape(ring);
  out.normal = fan.normal / length;
  lay_out(chart.ring, chart.height, ring.closed ? total : full_turn, ring);
  for (std::size_t j = 0; j < size; ++j) chart.height[j] = out.normal.dot(ring.offset[j]);

  if (!ring.closed) {
    const Vec3 hessian = open_hessian(chart);
    out.area = fan.barycentric;
    out.trace = std::numbers::sqrt2 * hessian[0];
    out.trace_free = {hessian[1], hessian[2]};
    return out;
  }
  for (std::size_t j = 0; j < size; ++j)
    chart.weight[j] = (ring.far[j] ? far_corner_weight : 1.0) / chart.ring[j].squaredNorm();
  out.area = std::max(fan.circumcentric, least_area_share * fan.barycentric);
  out.trace = out.normal.dot(fan.laplacian) / out.area;
  if (out.area != fan.circumcentric)
    out.trace += (1 - fan.circumcentric / out.area) * std::numbers::sqrt2 *
                 fitted_hessian(chart.ring, chart.height, chart.weight)[0];
  // What the trace explains is not the trace-free part's; the same where the ring determines a
  // quadratic.
  for (std::size_t j = 0; j < size; ++j)
    chart.rest[j] = chart.height[j] - 0.25 * out.trace * chart.ring[j].squaredNorm();
  const Vec3 hessian = fitted_hessian(chart.ring, chart.rest, chart.weight);
  out.trace_free = {hessian[1], hessian[2]};
  return out;
}

void linearize(const SurfaceRing& ring, CurvatureEnergy energy, ShapeRows& out) {
  out.point = point_curvature(ring, out.chart);
  if (!out.point.has_rows()) return;
  out.shape = {root_half * out.point.trace, out.point.trace_free[0], out.point.trace_free[1]};
  if (ring.closed) {
    hessian_rows(out.chart.ring, out.chart.weight, out.row);
    const double scale = root_half / out.point.area;
    // Like the trace-free part itself, its rows leave to the trace what is the trace's.
    Eigen::Vector2d of_round = Eigen::Vector2d::Zero();
    for (std::size_t j = 0; j < out.row.size(); ++j)
      of_round += out.chart.ring[j].squaredNorm() * out.row[j].tail<2>();
    of_round *= 0.5 * root_half;
    for (std::size_t j = 0; j < out.row.size(); ++j) {
      out.row[j][0] = scale * out.chart.cotangent[j];
      out.row[j].tail<2>() -= out.row[j][0] * of_round;
    }
  } else {
    const FitRows rows = fit({out.chart.ring, 0, false});
    out.row.resize(out.chart.ring.size());
    for (std::size_t j = 0; j < out.row.size(); ++j)
      out.row[j] = rows.col(Eigen::Index(j)).tail<3>();
  }
  const auto [a, b] = out.point.trace_free;
  own_term(energy, out.point.trace, a, b, a * a + b * b, out.own[0], out.own[1], out.own[2]);
  for (const Vec3& row : out.row) out.own -= row;
}

Vec3 chart_axis(const Vec3& normal, std::span<const Vec3> ring, const SurfaceChart& chart) {
  if (ring.empty()) return Vec3::Zero();
  const Vec3 u = (ring[0] - ring[0].dot(normal) * normal).normalized(), v = normal.cross(u);
  Vec2 turn = Vec2::Zero();
  for (std::size_t j = 0; j < ring.size(); ++j) {
    const Vec2 d = Vec2(ring[j].dot(u), ring[j].dot(v)).normalized(),
               c = chart.ring[j].normalized();
    turn += Vec2(d.dot(c), d.y() * c.x() - d.x() * c.y());
  }
  turn.normalize();
  return turn.x() * u + turn.y() * v;
}

}  // namespace fairing
