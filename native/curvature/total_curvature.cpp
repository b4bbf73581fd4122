// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/total_curvature.h"

#include <algorithm>

#include "curvature/cotangent_curvature.h"
#include "curvature/rings.h"

namespace fairing {

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
