// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/total_curvature.h"

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

ElementSums total_curvature_of_elements(const GridLevel& grid, Workers& workers, const double* x) {
  // Lifted areas would add up to more than the surface has; the fit's trace, which is not
  // symmetric, does no harm here.
  constexpr const float* lift = nullptr;
  struct Local {
    RingWalk walk;
    SurfaceChart chart{};
  };
  ElementSums sums(grid.mesh());
  for_each_run(
      grid, workers, [&] { return Local{RingWalk(grid, x, lift)}; },
      [&](const Run& run, Local& own) {
        if (!is_measured(grid.mesh(), run)) return;
        own.walk(run, [&](std::size_t, const RingInSpace& ring, bool) {
          const PointCurvature point = point_curvature(ring.view(true), own.chart);
          sums.of(run) += point.area * point.density();
        });
      });
  return sums;
}

}  // namespace

double total_curvature(const GridLevel& grid, Workers& workers, const double* x) {
  return total_curvature_of_elements(grid, workers, x).total();
}

std::vector<double> total_curvature_of_stars(const GridLevel& grid, Workers& workers,
                                             const double* x) {
  ElementSums sums = total_curvature_of_elements(grid, workers, x);
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
