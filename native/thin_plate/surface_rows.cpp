// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/surface_rows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "base/roundoff.h"
#include "grid/limit_surface.h"
#include "grid/ring_shape.h"
#include "stencil/angle.h"
#include "stencil/chart.h"
#include "stencil/weights.h"

namespace fairing {
namespace {

// One ring in space, counter-clockwise.
struct SpaceRing {
  std::span<const Vec3> offset;       // of the neighbours from the point, at unit grid spacing
  std::span<const std::uint8_t> far;  // whether they lie across a quad
  std::size_t first = 0;              // start of an open ring
  bool closed = true;
};

double power(const Vec3& offset, double exponent) {
  const double square = offset.squaredNorm();
  return exponent == centripetal ? std::sqrt(std::sqrt(square)) : std::pow(square, 0.5 * exponent);
}

// Unfolds the ring with lengths raised to `exponent` as in flatten(): every triangle of the point
// and two neighbours is flattened with these. Neighbours are in the order of the ring. False if the
// ring is degenerate; the chart is then invalid.
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

// The point's share of the ring's area, as Chart::area, with the ring's own lengths.
double area_of(const SpaceRing& ring) {
  const std::size_t size = ring.offset.size();
  double sum = 0;
  for (std::size_t k = 0; k < (ring.closed ? size : size - 1); ++k) {
    const std::size_t i = (ring.first + k) % size, j = (i + 1) % size;
    const double faces = ring.far[i] || ring.far[j] ? 4 : 3;
    sum += 0.5 * ring.offset[i].cross(ring.offset[j]).norm() / faces;
  }
  return sum;
}

// A thread's ring in space, and its chart.
struct Local {
  RunGather<double, 3> gather;
  RingShape shape{};
  std::vector<Vec3> offset{};
  Chart chart{};

  SpaceRing ring() const { return {offset, shape.far, std::size_t(shape.first), shape.closed}; }
};

}  // namespace

SurfaceRows::SurfaceRows(const GridLevel& grid, const Stencils& stencils,
                         const SurfaceMetric& metric, const Unknowns& unknowns, Workers& workers)
    : rows(grid), penalty(grid.size()) {
  const double n = double(grid.n());
  const Array<double> weight = point_weights(grid);
  const auto set_point = [&](const Run& run, std::size_t i, Local& local) {
    const std::span<const Stencils::Column> usual = stencils.columns(element_of(grid.mesh(), run));
    const RowRun<float> to = rows.of(run);
    const SpaceRing ring = local.ring();
    const double scale = n * std::sqrt(weight.empty() ? 1.0 : weight[run.first + i]);
    const auto put = [&](auto&& row) {
      for (int c = 0; c < 3; ++c) {
        double own = 0;  // constants have no differences
        for (int s = 1; s < to.slots; ++s)
          own -= double(to.at(c, s, i) = float(scale * row(c, s - 1)));
        to.at(c, 0, i) = float(own);
      }
    };
    if (!chart_in_space(ring, metric.exponent, local.chart))
      return put([&](int c, int s) { return usual[std::size_t(s)][std::size_t(c)]; });
    const FitRows fitted = fit(local.chart);
    const double root = std::sqrt(local.chart.area);
    put([&](int c, int s) { return root * fitted(c + 2, s); });
    if (!unknowns.has(run)) return;
    Eigen::Matrix3d bending = Eigen::Matrix3d::Zero();
    for (int s = 1; s < to.slots; ++s)
      bending += ring.offset[std::size_t(s - 1)] *
                 Eigen::RowVector3d(to.at(0, s, i), to.at(1, s, i), to.at(2, s, i));
    const std::size_t p = run.first + i;
    if (std::isinf(metric.penalty[p])) {
      for (int c = 0; c < 3; ++c)
        penalty[p] += float(flat_penalty) * to.at(c, 0, i) * to.at(c, 0, i);
      return;
    }
    penalty[p] = float(bending.squaredNorm() / (n * n) * std::pow(area_of(ring), 2) *
                       std::pow(metric.penalty[p], 4));
  };
  for_each_run(
      grid, workers, [&] { return Local{{grid, metric.surface}}; },
      [&](const Run& run, Local& local) {
        std::fill_n(penalty.data() + run.first, run.count, 0.0f);
        if (!stencils.has_fit[std::size_t(element_of(grid.mesh(), run))]) return;  // zero
        const double* const* at = local.gather(run);
        local.shape.set(grid, run);
        local.offset.resize(local.shape.far.size());
        for (std::size_t i = 0; i < run.count; ++i) {
          for (std::size_t s = 0; s < local.offset.size(); ++s)
            local.offset[s] = n * (Eigen::Map<const Vec3>(at[s + 1] + 3 * i) -
                                   Eigen::Map<const Vec3>(at[0] + 3 * i));
          set_point(run, i, local);
        }
      });
}

}  // namespace fairing
