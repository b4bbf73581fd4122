// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/turns.h"

#include "grid/runs.h"

namespace fairing {
namespace {

double turn_on_edge(const GridLevel& grid, Index e, const double* x, std::vector<double>& scratch) {
  const EdgeLanes<double> lanes(grid, x, e, scratch);
  const auto at = [&](std::size_t lane, int k) {
    return Vec3(Eigen::Map<const Vec3>(lanes.lane[lane] + 3 * k));
  };
  const auto cell = [&](std::size_t h, int from, int to) {
    const Face& face = grid.mesh().faces[grid.mesh().face_beside(e, h)];
    const Vec3 a = at(0, from), b = at(0, to);
    if (face.quad()) return left_cell(a, b, at(1 + h, from), at(1 + h, to));
    return left_cell(a, b, at(1 + h, std::min(from, to)));
  };
  SharpestTurn turn(0);
  for (int k = 0; k < grid.n(); ++k) turn.between(cell(0, k, k + 1), cell(1, k + 1, k));
  return turn.angle();
}

}  // namespace

std::vector<double> sharpest_turns(const GridLevel& grid, Workers& workers, const double* x) {
  const ControlMesh& mesh = grid.mesh();
  std::vector<double> turns(mesh.faces.size(), 0.0), on_edge(mesh.edges.size(), 0.0);
  for_face_parts(grid, workers, [&](Index begin, Index end) {
    std::vector<double> closed(3 * closed_size(true, std::size_t(grid.n())));
    for (Index f = begin; f < end; ++f) {
      if (mesh.face_part(f) != RegionPart::inside) continue;
      const bool quad = mesh.faces[f].quad();
      gather_face(grid, x, f, closed.data());
      const auto at = [&](GridPoint p) {
        const std::size_t row = closed_row(quad, std::size_t(grid.n()), std::size_t(p.j));
        return Vec3(Eigen::Map<const Vec3>(closed.data() + 3 * (row + std::size_t(p.i))));
      };
      turns[f] = turn_in_face(quad, grid.n(), 0, at, [](GridPoint, GridPoint) { return true; });
    }
  });
  for_edge_parts(grid, workers, [&](Index begin, Index end) {
    std::vector<double> scratch;
    for (Index e = begin; e < end; ++e)
      if (is_joined(mesh, e)) on_edge[e] = turn_on_edge(grid, e, x, scratch);
  });
  for (Index e = 0; e < Index(mesh.edges.size()); ++e)
    for (std::size_t h = 0; h < 2 && is_joined(mesh, e); ++h) {
      double& most = turns[mesh.face_beside(e, h)];
      most = std::max(most, on_edge[e]);
    }
  return turns;
}

}  // namespace fairing
