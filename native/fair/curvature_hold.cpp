// SPDX-License-Identifier: GPL-3.0-or-later
// Control vertices that take part in the steps: within a tolerance, or let go by epsilon.
#include "fair/curvature.h"

namespace fairing {
namespace {

constexpr int release_rounds = 2;
constexpr double release_pull = 0.1;    // of a weight that balances a control edge
constexpr double release_aim = 0.9999;  // of epsilon: rounding must not carry a vertex over it

}  // namespace

// After a step within a tolerance: other weights, another energy.
void CurvatureSystem::adapt_hold(int level) {
  hold_.adapt(surface_);
  shared_.weights = hold_.weights();
  anderson_.reset();
  energy_ = op(level).linearize(surface_.data(), &here_);
}

// From here on held control vertices stay where they are, at most at the tolerance.
void CurvatureSystem::finish_hold(int level, CurvatureLevelReport& report) {
  shared_.unknowns = hold_.without_held();
  shared_.weights.clear();
  if (!hold_.adapts()) return;
  hold_.enforce(surface_);
  follow(level, report);
}

// A few plain steps after control vertices have been moved; without them where they do not settle.
void CurvatureSystem::follow(int level, CurvatureLevelReport& report) {
  energy_ = op(level).linearize(surface_.data(), &here_);
  const Found moved = found();
  CurvatureLevelReport followed = report;
  followed.converged = false;
  minimize(level, Mode::plain, {0, options_.step_tolerance}, short_patience, followed);
  if (followed.converged && followed.energy <= moved.energy)
    report = followed;
  else
    restore(moved);
}

// One step in which interpolated control vertices take part, drawn to their places as much as a control edge is stiff;
// none goes further than epsilon. Then the surface follows.
void CurvatureSystem::release(int level, CurvatureLevelReport& report) {
  const Unknowns fixed = shared_.unknowns;
  Unknowns freed = fixed;
  for (Index v = 0; v < mesh_.input_vertices; ++v) {
    const bool held = fixed.vertex[std::size_t(v)] || mesh_.feature_vertex[std::size_t(v)] ||
                      mesh_.ring(v).empty() || mesh_.vertex_place(v) != Place::inside;
    if (!held) freed.vertex[std::size_t(v)] = freed.any_vertex = true;
  }
  const std::vector<Vec3> places = mesh_.positions;
  for (int round = 0; round < release_rounds; ++round) {
    shared_.unknowns = freed;
    shared_.weights.assign(places.size(), 0.0);
    shared_.targets = places;
    for (std::size_t v = 0; v < places.size(); ++v)
      if (freed.vertex[v] && !fixed.vertex[v])
        shared_.weights[v] = release_pull * curvature_weight_unit(mesh_);
    energy_ = op(level).linearize(surface_.data(), &here_);
    linearize_below(level);
    damp(level, {});
    StepReport ignored;
    solve_step(level, ignored, true);
    for (std::size_t v = 0; v < places.size(); ++v) {
      if (!freed.vertex[v] || fixed.vertex[v]) continue;
      const Eigen::Map<const Vec3> normal(here_.normal.data() + 3 * v);
      Eigen::Map<Vec3> p(surface_.data() + 3 * v);
      Vec3 offset = p + step_[v] * normal - places[v];
      const double length = offset.norm();
      if (length > release_aim * epsilon_) offset *= release_aim * epsilon_ / length;
      p = places[v] + offset;
    }
    symmetrize(level, surface_);
    shared_.unknowns = fixed;
    shared_.weights.clear();
    follow(level, report);
  }
}

}  // namespace fairing
