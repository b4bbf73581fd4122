// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/total_curvature.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "curvature/rings.h"
#include "stencil/angle.h"

namespace fairing {
namespace {

struct Sums {
  Vec3 laplacian = Vec3::Zero();  // half cotangents times offsets
  double area = 0, angle = 0;

  // The triangle between the point and two of its neighbours.
  void add(const Vec3& a, const Vec3& b, double share) {
    const double aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b),
                 longest = std::max({aa, bb, (a - b).squaredNorm()}),
                 square = a.cross(b).squaredNorm(), sine = std::sqrt(square);
    if (square > thinnest_ring_square * aa * bb)
      angle += share * angle_of(sine, ab, std::sqrt(aa * bb));
    else if (ab < 0)
      angle += share * std::numbers::pi;
    if (!(square > thinnest_ring_square * longest * longest)) return;
    const double scale = 0.5 * share / sine, at_a = scale * (aa - ab), at_b = scale * (bb - ab);
    laplacian += at_b * a + at_a * b;
    if (ab < 0)
      area += 0.25 * share * sine;  // half of the triangle if the obtuse angle is at the point
    else if (at_a < 0 || at_b < 0)
      area += 0.125 * share * sine;
    else
      area += 0.25 * (at_b * aa + at_a * bb);
  }
};

struct CotangentCurvature {
  double mean = 0;   // the integral of 2 H^2, (k1 + k2)^2 / 2, over the point's mixed area
  double gauss = 0;  // the integral of K: a full turn minus the sum of the angles
};

// Curvature of a ring by cotangents and angles [Meyer, Desbrun, Schroeder, Barr 2003]: less accurate
// than a fit (point_curvature.h), but bounded by the ring's own bending.
//
// For a closed ring. A quad counts as the mean of its two triangulations; triangles without an area
// count by their angle only. Sums are exact: over a closed surface `gauss` is 2 pi times its Euler
// characteristic. A ring that is not finite, or exceeds ring_farthest, has an infinite `mean`.
CotangentCurvature cotangent_curvature(const SurfaceRing& ring) {
  const std::size_t size = ring.offset.size();
  const auto after = [&](std::size_t j) { return j + 1 < size ? j + 1 : 0; };
  for (const Vec3& offset : ring.offset)
    if (!(offset.squaredNorm() < ring_farthest))
      return {std::numeric_limits<double>::infinity(), 0};
  Sums sums;
  for (std::size_t j = 0; j < size; ++j) {
    const std::size_t next = after(j);
    sums.add(ring.offset[j], ring.offset[next], ring.far[j] || ring.far[next] ? 0.5 : 1.0);
    if (ring.far[next]) sums.add(ring.offset[j], ring.offset[after(next)], 0.5);
  }
  CotangentCurvature out;
  if (sums.area > 0) out.mean = 0.5 * sums.laplacian.squaredNorm() / sums.area;
  out.gauss = 2 * std::numbers::pi - sums.angle;
  return out;
}

}  // namespace

double total_curvature(const GridLevel& grid, Workers& workers, const double* x) {
  constexpr const float* lift = nullptr;
  ElementSums mean(grid.mesh()), gauss(grid.mesh());
  for_each_run(
      grid, workers, [&] { return RingWalk(grid, x, lift); },
      [&](const Run& run, RingWalk& walk) {
        const ControlMesh& mesh = grid.mesh();
        if (!has_fit(mesh, run) || part_of_region(mesh, run) != RegionPart::inside) return;
        walk(run, [&](std::size_t, const RingInSpace& ring, bool closed) {
          if (!closed) return;
          const CotangentCurvature point = cotangent_curvature(ring.view(true));
          mean.of(run) += point.mean;
          gauss.of(run) += point.gauss;
        });
      });
  // The remainder beside the part of the mean curvature is the integral of (k1 - k2)^2 / 2.
  const double sum = mean.total();
  return sum + std::max(sum - 2 * gauss.total(), 0.0);
}

}  // namespace fairing
