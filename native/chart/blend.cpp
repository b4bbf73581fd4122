// SPDX-License-Identifier: GPL-3.0-or-later
#include "chart/blend.h"

#include <cmath>

namespace fairing {
namespace {

double mean_radius(const Chart& chart) {
  double sum = 0;
  for (const Vec2& p : chart.ring) sum += p.norm();
  return sum / double(chart.ring.size());
}

}  // namespace

void blend(const Chart& uniform, double alpha, Chart& chart) {
  const double scale = mean_radius(chart) / mean_radius(uniform);
  double cosine = 0, sine = 0;
  for (std::size_t k = 0; k < chart.ring.size(); ++k) {
    const Vec2 &from = uniform.ring[k], &to = chart.ring[k];
    cosine += from.dot(to);
    sine += from.x() * to.y() - from.y() * to.x();
  }
  const double length = std::hypot(cosine, sine);
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
  if (length > 0) turn << cosine / length, -sine / length, sine / length, cosine / length;
  for (std::size_t k = 0; k < chart.ring.size(); ++k)
    chart.ring[k] = alpha * chart.ring[k] + (1 - alpha) * scale * (turn * uniform.ring[k]);
  chart.area = alpha * chart.area + (1 - alpha) * scale * scale * uniform.area;
}

}  // namespace fairing
