// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/shape_rows.h"

#include <Eigen/Geometry>
#include <numbers>

#include "difference/hessian.h"

namespace fairing {
namespace {

constexpr double root_half = std::numbers::sqrt2 / 2;

// M^2 = (t^2/4 + f^2) I + t F, where M = t/2 I + F with F trace-free and F^2 = f^2 I.
Vec3 own_term(const PointCurvature& m, CurvatureEnergy energy) {
  const double t = m.trace, a = m.trace_free[0], b = m.trace_free[1], square = a * a + b * b;  // 2 f^2
  if (energy == CurvatureEnergy::total_curvature) return {root_half * square, 0.5 * t * a, 0.5 * t * b};
  return {root_half * (0.5 * t * t + square), t * a, t * b};
}

}  // namespace

void linearize(const SurfaceRing& ring, CurvatureEnergy energy, ShapeRows& out) {
  out.point = point_curvature(ring, out.chart);
  if (!(out.point.area > 0)) return;
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
    for (std::size_t j = 0; j < out.row.size(); ++j) out.row[j] = rows.col(Eigen::Index(j)).tail<3>();
  }
  out.own = own_term(out.point, energy);
  for (const Vec3& row : out.row) out.own -= row;
}

Vec3 chart_axis(const Vec3& normal, std::span<const Vec3> ring, const SurfaceChart& chart) {
  if (ring.empty()) return Vec3::Zero();
  const Vec3 u = (ring[0] - ring[0].dot(normal) * normal).normalized(), v = normal.cross(u);
  Vec2 turn = Vec2::Zero();
  for (std::size_t j = 0; j < ring.size(); ++j) {
    const Vec2 d = Vec2(ring[j].dot(u), ring[j].dot(v)).normalized(), c = chart.ring[j].normalized();
    turn += Vec2(d.dot(c), d.y() * c.x() - d.x() * c.y());
  }
  turn.normalize();
  return turn.x() * u + turn.y() * v;
}

}  // namespace fairing
