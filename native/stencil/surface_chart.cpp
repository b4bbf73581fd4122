// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/surface_chart.h"

#include <algorithm>
#include <cmath>

#include "base/roundoff.h"
#include "stencil/angle.h"

namespace fairing {
namespace {

double power(const Vec3& offset, double exponent) {
  const double square = offset.squaredNorm();
  return exponent == centripetal ? std::sqrt(std::sqrt(square)) : std::pow(square, 0.5 * exponent);
}

}  // namespace

bool chart_in_space(const SpaceRing& ring, double exponent, Chart& chart) {
  const std::size_t size = ring.offset.size(), steps = ring.closed ? size : size - 1;
  chart.ring.resize(size);
  chart.area = 0;
  chart.closed = ring.closed;
  const auto at = [&](std::size_t k) { return (ring.first + k) % size; };
  // radii and turns, stored in place of coordinates
  double longest = 0, shortest = HUGE_VAL, total = 0;
  for (std::size_t j = 0; j < size; ++j) {
    const double radius = power(ring.offset[j], exponent);
    longest = std::max(longest, radius);
    shortest = std::min(shortest, radius);
    chart.ring[j] = Vec2(radius, 0);
  }
  if (!(shortest > single_roundoff * longest) || !std::isfinite(longest)) return false;
  for (std::size_t k = 0; k < steps; ++k) {
    const std::size_t i = at(k), j = at(k + 1);
    const double a = chart.ring[i].x(), b = chart.ring[j].x(),
                 c = power(ring.offset[j] - ring.offset[i], exponent);
    const double cosine = std::clamp((a * a + b * b - c * c) / (2 * a * b), -1.0, 1.0),
                 sine = std::sqrt(1 - cosine * cosine);
    chart.ring[i].y() = angle_of(sine, cosine, 1);
    total += chart.ring[i].y();
    chart.area += 0.5 * a * b * sine / (ring.far[i] || ring.far[j] ? 4 : 3);
  }
  if (!(total > single_roundoff * full_turn) || !(chart.area > 0)) return false;
  const double scale = turn_scale(ring.closed, total);
  double angle = 0;
  for (std::size_t k = 0; k < size; ++k) {
    Vec2& p = chart.ring[at(k)];
    const double turn = k < steps ? p.y() : 0;
    p = p.x() * Vec2(std::cos(scale * angle), std::sin(scale * angle));
    angle += turn;
  }
  return true;
}

}  // namespace fairing
