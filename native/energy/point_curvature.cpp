// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/point_curvature.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "chart/angle.h"
#include "difference/hessian.h"

namespace fairing {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;
constexpr double least_share = 0.1;  // of the barycentric area
constexpr double thinnest = 1e-24;   // squared sine below which a triangle has no cotangents
constexpr double root_two = std::numbers::sqrt2;

// A neighbour with the reciprocal of its squared distance.
struct Spoke3 {
  Vec3 p;
  double square, inverse;
  explicit Spoke3(const Vec3& offset) : p(offset), square(offset.squaredNorm()), inverse(1 / square) {}
};

// The corner that two spokes span at p_i.
struct Corner3 {
  Vec3 cross;
  double sine, cosine;  // times both lengths
  Corner3(const Spoke3& a, const Spoke3& b)
      : cross(a.p.cross(b.p)), sine(cross.norm()), cosine(a.p.dot(b.p)) {}
};

// Sums over the triangles between the point and its ring.
struct Fan {
  Vec3 normal = Vec3::Zero();
  Vec3 laplacian = Vec3::Zero();  // half cotangents times offsets
  double circumcentric = 0, barycentric = 0;

  void add(const Spoke3& a, const Spoke3& b, const Corner3& corner, double weight) {
    if (!(corner.sine * corner.sine > thinnest * a.square * b.square)) return;
    normal += (weight * a.inverse * b.inverse) * corner.cross;
    const double scale = 0.5 * weight / corner.sine;
    const double at_a = scale * (a.square - corner.cosine), at_b = scale * (b.square - corner.cosine);
    laplacian += at_b * a.p + at_a * b.p;
    circumcentric += 0.25 * (at_b * a.square + at_a * b.square);
    barycentric += weight / 6 * corner.sine;
  }
};

// Turns the ring's corners into its chart. On entry chart[j] is the unit vector of the angle before neighbour j, and
// angle[j] its size.
inline void close_chart(std::span<Vec2> chart, std::span<const double> angle, double total,
                        const SurfaceRing& ring) {
  const double excess = full_turn / total - 1;
  Vec2 direction(1, 0);
  chart[0] = direction * ring.offset[0].norm();
  for (std::size_t j = 1; j < chart.size(); ++j) {
    double cosine, sine;
    small_turn(excess * angle[j], cosine, sine);
    const Vec2 corner = chart[j];
    const Vec2 turn(corner.x() * cosine - corner.y() * sine, corner.x() * sine + corner.y() * cosine);
    direction = Vec2(direction.x() * turn.x() - direction.y() * turn.y(),
                     direction.x() * turn.y() + direction.y() * turn.x());
    chart[j] = direction * ring.offset[j].norm();
  }
}

}  // namespace

PointCurvature point_curvature(const SurfaceRing& ring, SurfaceChart& chart) {
  const std::size_t size = ring.offset.size();
  chart.ring.resize(size);
  chart.height.resize(size);
  std::vector<double>& angle = chart.height;  // until the heights are known
  Fan fan;
  double total = 0;
  const Spoke3 first(ring.offset[0]);
  Spoke3 a = first;
  if (!(a.square > 0)) return {};
  for (std::size_t j = 1; j <= size; ++j) {
    const std::size_t here = j < size ? j : 0;
    const Spoke3 b = here ? Spoke3(ring.offset[j]) : first;
    if (!(b.square > 0)) return {};
    const Corner3 corner(a, b);
    fan.add(a, b, corner, ring.far[j - 1] || ring.far[here] ? 0.5 : 1.0);
    if (ring.far[here]) {
      const Spoke3 c(ring.offset[j + 1 < size ? j + 1 : 0]);
      if (!(c.square > 0)) return {};
      fan.add(a, c, Corner3(a, c), 0.5);
    }
    const double inverse = std::sqrt(a.inverse * b.inverse);
    const double size_of = angle_of(corner.sine * inverse, corner.cosine * inverse, 1);
    total += size_of;
    chart.ring[here] = Vec2(corner.cosine * inverse, corner.sine * inverse);
    angle[here] = size_of;
    a = b;
  }
  PointCurvature out;
  const double length = fan.normal.norm();
  if (!(length > 0 && total > 0 && std::isfinite(length))) return {};
  out.normal = fan.normal / length;
  close_chart(chart.ring, angle, total, ring);
  for (std::size_t j = 0; j < size; ++j) chart.height[j] = out.normal.dot(ring.offset[j]);

  const Vec3 hessian = fitted_hessian(chart.ring, chart.height);
  out.trace_free = {hessian[1], hessian[2]};
  out.area = fan.circumcentric;
  out.trace = out.normal.dot(fan.laplacian) / out.area;
  if (!(out.area > least_share * fan.barycentric)) {
    out.area = least_share * fan.barycentric;
    out.trace = root_two * hessian[0];
  }
  return out;
}

}  // namespace fairing
