// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/total_curvature.h"

#include <algorithm>

#include "curvature/cotangent_curvature.h"
#include "curvature/rings.h"

namespace fairing {
namespace {

bool is_measured(const ControlMesh& mesh, const Run& run) {
  const Index e = run.element;
  switch (run.kind) {
    case RunKind::vertex:
      return !mesh.feature_vertex[e] && mesh.interior(e) &&
             mesh.vertex_part(e) == RegionPart::inside;
    case RunKind::edge:
      return !mesh.feature_edge[e] && !mesh.edges[e].boundary() &&
             mesh.edge_part(e) == RegionPart::inside;
    default: return mesh.face_part(e) == RegionPart::inside;
  }
}

}  // namespace

double total_curvature(const GridLevel& grid, Workers& workers, const double* x) {
  constexpr const float* lift = nullptr;
  ElementSums mean(grid.mesh()), gauss(grid.mesh());
  for_each_run(
      grid, workers, [&] { return RingWalk(grid, x, lift); },
      [&](const Run& run, RingWalk& walk) {
        if (!is_measured(grid.mesh(), run)) return;
        walk(run, [&](std::size_t, const RingInSpace& ring, bool) {
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
