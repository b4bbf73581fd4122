// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/point_curvature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "curvature/ring_fan.h"

namespace fairing {
namespace {

using Fan = RingFan<double>;

// Sets the rows of the fit; few points have an open ring.
void set_rows(bool closed, SurfaceChart& chart) {
  if (closed) return hessian_rows(chart.ring, chart.weight, chart.row);
  const FitRows rows = fit({chart.ring, 0, false});
  chart.row.resize(chart.ring.size());
  for (std::size_t j = 0; j < chart.row.size(); ++j)
    chart.row[j] = rows.col(Eigen::Index(j)).tail<3>();
}

// False if a neighbour coincides with the point. `angles`: whether to compute the angles.
template <bool angles>
bool sum_up(const SurfaceRing& ring, SurfaceChart& chart, Fan& fan) {
  const std::size_t size = ring.offset.size();
  chart.neighbour.resize(size);
  bool apart = size > 0;
  for (std::size_t j = 0; j < size; ++j) {
    const Vec3& p = ring.offset[j];
    chart.neighbour[j].p = {p.x(), p.y(), p.z()};
    Fan::measure(chart.neighbour[j], apart);
  }
  fan.at = chart.neighbour.data();
  fan.size = int(size);
  if (apart) fan.sum_up<angles>(ring.far.data(), ring.closed, apart);
  return apart;
}

// The result for a ring that determines no curvature: zero if it has shrunk to a point, infinite if
// it is not finite, so that such a surface never has the least energy.
PointCurvature without_shape(const SurfaceRing& ring) {
  for (const Vec3& offset : ring.offset)
    if (!(offset.squaredNorm() < ring_farthest)) return PointCurvature::infinite();
  return {};
}

// Copies the fit's input from the fan to the chart.
void read_chart(const SurfaceRing& ring, const Fan& fan, const Vec3& normal, SurfaceChart& chart) {
  const std::size_t size = ring.offset.size();
  for (auto* numbers : {&chart.height, &chart.weight, &chart.cotangent}) numbers->resize(size);
  chart.ring.resize(size);
  for (std::size_t j = 0; j < size; ++j) {
    const RingNeighbour<double>& n = fan.at[j];
    chart.ring[j] = n.radius * Vec2(n.turn.cosine, n.turn.sine);
    chart.height[j] = normal.dot(ring.offset[j]);
    chart.weight[j] = n.weight;
    chart.cotangent[j] = n.cotangent;
  }
}

}  // namespace

float area_lift(const SurfaceRing& ring, SurfaceChart& chart) {
  Fan fan{};
  if (!ring.closed || !sum_up<false>(ring, chart, fan)) return 0;
  const double missing = least_area_share * fan.barycentric - fan.circumcentric;
  if (!(missing > 0)) return 0;
  double negative = 0;
  for (const RingNeighbour<double>& n : chart.neighbour)
    negative += 0.25 * std::max(-n.cotangent, 0.0) * n.square;
  return negative > missing ? float(missing / negative) : 1.0f;
}

PointCurvature point_curvature(const SurfaceRing& ring, SurfaceChart& chart) {
  Fan fan{};
  if (!sum_up<true>(ring, chart, fan)) return without_shape(ring);
  if (!ring.lift.empty())
    fan.lift([&](int j, double& share) { share = double(std::max(ring.own_lift, ring.lift[j])); });
  bool usable = true;
  fan.normalize(usable);
  if (!usable) return without_shape(ring);
  PointCurvature out;
  out.normal = {fan.normal.x, fan.normal.y, fan.normal.z};
  fan.lay_out(ring.closed ? fan.total : full_turn, ring.far.data(), usable);
  read_chart(ring, fan, out.normal, chart);
  set_rows(ring.closed, chart);
  // Of the heights, less a multiple of the squared distances.
  const auto hessian_less = [&](double share) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t j = 0; j < chart.row.size(); ++j)
      sum += (chart.height[j] - share * fan.at[j].square) * chart.row[j];
    return sum;
  };

  if (!ring.closed) {
    const Vec3 hessian = hessian_less(0);
    out.area = fan.barycentric;
    out.trace = std::numbers::sqrt2 * hessian[0];
    out.trace_free = {hessian[1], hessian[2]};
    return out;
  }
  out.area = std::max(fan.circumcentric, least_area_share * fan.barycentric);
  double of_cotangents;
  Fan::dot(fan.normal, fan.laplacian, of_cotangents);
  out.trace = of_cotangents / out.area;
  if (out.area != fan.circumcentric)
    out.trace += (1 - fan.circumcentric / out.area) * std::numbers::sqrt2 * hessian_less(0)[0];
  // The trace-free part fits what the trace does not explain (nothing, for exact quadratics).
  const Vec3 hessian = hessian_less(0.25 * out.trace);
  out.trace_free = {hessian[1], hessian[2]};
  return out;
}

void linearize(const SurfaceRing& ring, CurvatureEnergy energy, ShapeRows& out) {
  out.point = point_curvature(ring, out.chart);
  if (!out.point.has_rows()) return;
  out.shape = {root_half * out.point.trace, out.point.trace_free[0], out.point.trace_free[1]};
  out.row = out.chart.row;
  if (ring.closed) {
    const double scale = root_half / out.point.area;
    // The trace's part is subtracted from the trace-free rows too.
    Eigen::Vector2d of_round = Eigen::Vector2d::Zero();
    for (std::size_t j = 0; j < out.row.size(); ++j)
      of_round += out.chart.ring[j].squaredNorm() * out.row[j].tail<2>();
    of_round *= 0.5 * root_half;
    for (std::size_t j = 0; j < out.row.size(); ++j) {
      out.row[j][0] = scale * out.chart.cotangent[j];
      out.row[j].tail<2>() -= out.row[j][0] * of_round;
    }
  }
  const auto [a, b] = out.point.trace_free;
  own_term(energy, out.point.trace, a, b, a * a + b * b, out.own[0], out.own[1], out.own[2]);
  for (const Vec3& row : out.row) out.own -= row;
}

Vec3 chart_axis(const Vec3& normal, SurfaceChart& chart) {
  if (chart.neighbour.empty()) return Vec3::Zero();
  Fan fan{
      chart.neighbour.data(), int(chart.neighbour.size()), {normal.x(), normal.y(), normal.z()}};
  Fan::Vector axis;
  fan.find_axis(axis);
  return {axis.x, axis.y, axis.z};
}

}  // namespace fairing
