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
      return !mesh.feature_vertex[std::size_t(e)] && mesh.interior(e) &&
             mesh.vertex_part(e) == RegionPart::inside;
    case RunKind::edge:
      return !mesh.feature_edge[std::size_t(e)] && !mesh.edges[std::size_t(e)].boundary() &&
             mesh.edge_part(e) == RegionPart::inside;
    default: return mesh.face_part(e) == RegionPart::inside;
  }
}

// Calls visit(run, ring, state) for all points that are measured; for the states, see for_each_run.
template <class State, class Visit>
void visit_measured(const GridLevel& grid, Workers& workers, const double* x, Visit&& visit) {
  constexpr const float* lift = nullptr;
  struct Local {
    RingWalk walk;
    State state{};
  };
  for_each_run(
      grid, workers, [&] { return Local{RingWalk(grid, x, lift)}; },
      [&](const Run& run, Local& own) {
        if (!is_measured(grid.mesh(), run)) return;
        own.walk(run, [&](std::size_t, const RingInSpace& ring, bool) {
          visit(run, ring.view(true), own.state);
        });
      });
}

}  // namespace

double total_curvature(const GridLevel& grid, Workers& workers, const double* x) {
  struct Nothing {};
  ElementSums mean(grid.mesh()), gauss(grid.mesh());
  visit_measured<Nothing>(grid, workers, x, [&](const Run& run, const SurfaceRing& ring, Nothing&) {
    const CotangentCurvature point = cotangent_curvature(ring);
    mean.of(run) += point.mean;
    gauss.of(run) += point.gauss;
  });
  // What is left beside the mean curvature's part is the integral of (k1 - k2)^2 / 2.
  const double sum = mean.total();
  return sum + std::max(sum - 2 * gauss.total(), 0.0);
}

std::vector<double> total_curvature_of_stars(const GridLevel& grid, Workers& workers,
                                             const double* x) {
  ElementSums sums(grid.mesh());
  visit_measured<SurfaceChart>(grid, workers, x,
                               [&](const Run& run, const SurfaceRing& ring, SurfaceChart& chart) {
                                 const PointCurvature point = point_curvature(ring, chart);
                                 sums.of(run) += point.area * point.density();
                               });
  const ControlMesh& mesh = grid.mesh();
  std::vector<double> stars(std::size_t(mesh.vertex_count()));
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    double star = sums.vertex(v);
    for (const Spoke& spoke : mesh.ring(v))
      star += sums.edge(spoke.edge) + (spoke.face >= 0 ? sums.face(spoke.face) : 0.0);
    stars[std::size_t(v)] = star;
  }
  return stars;
}

}  // namespace fairing
