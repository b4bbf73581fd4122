// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/release.h"

#include "base/points.h"

namespace fairing {
namespace {

// Of the release by epsilon. Neighbouring control vertices share fits on grids coarser than
// first_undamped_level: they step half as far there.
constexpr int release_rounds = 3, first_undamped_level = 2;
constexpr double release_damping = 0.5;  // of such a step

}  // namespace

int release_control_vertices(ThinPlateSolver& solver, const PlateData& data, double epsilon,
                             PlateState& state, Array<double>& x) {
  ThinPlateShared& shared = solver.levels().shared();
  const ControlMesh& mesh = shared.mesh;
  const std::span<const Vec3> given = data.targets;
  Unknowns freed = shared.unknowns;
  bool any = false;
  for (std::size_t v = 0; v < std::size_t(mesh.first_centre()); ++v) {
    const bool released = !freed.vertex[v] && !mesh.feature_vertex[v] &&
                          !mesh.fans_meet(Index(v)) && !mesh.ring(Index(v)).empty() &&
                          mesh.vertex_part(Index(v)) == RegionPart::inside;
    freed.vertex[v] = released;
    any |= released;
  }
  if (!any) return 0;
  freed.any_vertex = true;
  const GridLevel& grid = solver.levels().grid(solver.levels().top());
  const VertexWeights none;
  const Array<float> diagonal =
      thin_plate_diagonal(grid, shared.stencils, freed, none, shared.workers, shared.double_slots);
  const double damping = grid.level() >= first_undamped_level ? 1.0 : release_damping;
  std::vector<Vec3> targets(given.begin(), given.end());
  Array<double> gradient(x.size());
  for (int round = 0; round < release_rounds; ++round) {
    apply_thin_plate(grid, shared.double_rows, freed, none, shared.workers, shared.double_slots,
                     x.data(), gradient.data());
    for (std::size_t v = 0; v < std::size_t(mesh.first_centre()); ++v) {
      if (!freed.vertex[v] || !(diagonal[v] > 0)) continue;
      // The energy is isotropic in one vertex, so the nearest point of the ball is the best one in
      // it.
      Vec3 offset =
          targets[v] - damping / double(diagonal[v]) * point_at(gradient, Index(v)) - given[v];
      const double length = offset.norm();
      if (length > tolerance_aim * epsilon) offset *= tolerance_aim * epsilon / length;
      targets[v] = given[v] + offset;
      put_point(targets[v], x.data() + 3 * v);
    }
    solver.solve_again({targets, data.curves}, PcgLimits().tolerance, state, x);
  }
  return release_rounds;
}

}  // namespace fairing
