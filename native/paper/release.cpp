// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/release.h"

#include "base/points.h"
#include "base/roundoff.h"

namespace fairing {
namespace {

// Number of steps of every vertex, each followed by a solve.
constexpr int release_steps = 3;

}  // namespace

int release_control_vertices(ThinPlateSolver& solver, const PlateData& data, double epsilon,
                             double tolerance, PlateState& state, Array<double>& x) {
  ThinPlateLevels& levels = solver.levels();
  const int top = levels.top();
  const ControlMesh& mesh = levels.shared().mesh;
  const std::span<const Vec3> given = data.targets;
  Unknowns freed = levels.shared().unknowns;
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
  const Array<float> diagonal = levels.diagonal_with(top, freed);
  // A row reaches two points, so with two pieces an edge neighbouring vertices are coupled, and
  // their steps are halved.
  const double damping = levels.grid(top).n() > 2 ? 1.0 : 0.5;
  // so that rounding does not exceed epsilon
  const double within = (1 - single_roundoff) * epsilon;
  std::vector<Vec3> targets(given.begin(), given.end());
  Array<double> gradient(x.size());
  for (int step = 0; step < release_steps; ++step) {
    levels.apply_with(top, freed, x.data(), gradient.data());
    for (std::size_t v = 0; v < std::size_t(mesh.first_centre()); ++v) {
      if (!freed.vertex[v] || !(diagonal[v] > 0)) continue;
      // The energy is isotropic in one vertex: the ball's nearest point is its minimum there.
      Vec3 offset =
          targets[v] - damping / double(diagonal[v]) * point_at(gradient, Index(v)) - given[v];
      const double length = offset.norm();
      if (length > within) offset *= within / length;
      targets[v] = given[v] + offset;
      put_point(targets[v], x.data() + 3 * v);
    }
    solver.solve_again({targets, data.curves, data.reference}, tolerance, state, x);
  }
  return release_steps;
}

}  // namespace fairing
