// SPDX-License-Identifier: GPL-3.0-or-later
// One Gauss-Newton step with control vertices on pads, with weights or within tolerances
// (constraints/held_solve.h). The loads act along the normals.
#include <utility>

#include "constraints/held_solve.h"
#include "curvature/system.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Tolerances of a step on the finest level: of each solve, relative to its first residual, and of
// the load corrections, relative to the force at the start of the step. The next step changes the
// loads anyway (measured: of 0.1, 0.2, 0.3 and 0.5, bob, a hull and spheres take the least time
// with 0.2). On coarser levels solves are more accurate, since their end decides where points lie
// along the surface, and loads are less accurate. If control vertices may move, both are `inexact`,
// since the active intervals depend on the forces.
constexpr double left_on_finest = 0.2, force_left_below = 0.3;
// Steps whose loads and active intervals do not settle within this number of corrections diverge.
constexpr int most_load_corrections = 6;

// Omega: the areas of the points, times the weight of the energy.
Array<double> areas_of(const Array<float>& shape, Workers& workers) {
  Array<double> areas(shape.size() / 4);
  for_each_index(workers, areas.size(), [&](std::size_t i) { areas[i] = area_of(&shape[4 * i]); });
  return areas;
}

// The loads that minimize the total force over Omega: M f = -Phi^T force.
NormalLoads fitting_loads(const Hats& hats, const Array<double>& force) {
  NormalLoads under = hats.gather(force), loads;
  for (auto& f : under) f = -f;
  hats.divide_by_mass<1>(under, loads);
  return loads;
}

}  // namespace

double GaussNewtonSystem::error_reduction(int level, const Functional& functional) const {
  return functional.pads && !constraints_ && level == finest() ? left_on_finest : inexact;
}

void GaussNewtonSystem::fix_control_vertices(Unknowns unknowns, int level,
                                             LinearizedSurface& surface) {
  constraints_ = nullptr;
  shared_.unknowns = std::move(unknowns);
  for (const auto& op : operators_) {
    op->set_weights({});
    op->unknowns_changed();
  }
  linearize(level, surface);
  linearize_below(level, surface);
}

void GaussNewtonSystem::set_weights(int level) {
  for (int l = base_; l <= level; ++l) op(l).set_weights(constraints_->weights());
}

// On the coarsest level the points of K are control vertices only.
void GaussNewtonSystem::linearize_about(const LinearizedSurface& about,
                                        const Multipliers<1>& held) {
  const Array<float>& diagonal = op(base_).diagonal();
  constraints_->linearize_about(
      about.linearization.normal.data(), about.points.data(), held.bounds,
      {diagonal.begin(), diagonal.begin() + std::ptrdiff_t(mesh().vertex_count())});
}

HeldLimits GaussNewtonSystem::held_limits(int level, const Functional& functional) const {
  const bool is_finest = level == finest();
  HeldLimits out;
  out.solve = limits(level, functional);
  if (functional.pads || is_bound()) out.solve.tolerance = error_reduction(level, functional);
  out.force = is_finest ? options_.load_tolerance : coarse_force_tolerance;
  out.of_first_force = constraints_ ? inexact : is_finest ? left_on_finest : force_left_below;
  out.gap = wanted_gap(level);
  out.of_first_gap = inexact;
  out.corrections = most_load_corrections;
  return out;
}

LevelSolve GaussNewtonSystem::solve_held(int level, const LinearizedSurface& about,
                                         Array<double>& h, Multipliers<1>& held,
                                         Array<double>& constraint_force, StepReport& report) {
  using Vector = HeldSystem<1>::Vector;
  const Array<double>& force = about.linearization.force;
  const auto hats = about.functional.pads
                        ? std::make_unique<Hats>(*about.functional.pads, grid(level),
                                                 areas_of(about.linearization.shape, workers()))
                        : nullptr;
  if (hats && held.loads.empty()) held.loads = fitting_loads(*hats, force);
  IntervalConstraints* const constraints = is_bound() ? constraints_ : nullptr;
  if (constraints) constraints->put_on_ends(h.data());
  const Unknowns& rows = hats ? hats->rows() : shared_.unknowns;
  bool is_zero = !constraints;  // whether h is zero
  const auto residual = [&](const double* x, double* r) {
    if (std::exchange(is_zero, false)) {
      for_each_index(workers(), h.size(), [&](std::size_t i) { r[i] = force[i]; });
      return;
    }
    op(level).apply_on(rows, x, r);
    for_each_index(workers(), h.size(), [&](std::size_t i) { r[i] = force[i] - r[i]; });
  };
  const std::size_t index = std::size_t(level - base_);
  using Restriction = decltype(HeldSystem<1>::restrict_to_vertices);
  const Restriction restriction = [&](std::span<const double> r, std::span<Vector> sums) {
    restrict_to_vertices<1>(
        transfers_, level, rows, workers(), r,
        [this](int l) { return hierarchy_->room(std::size_t(l - base_)); }, sums);
  };
  const HeldSystem<1> system{
      .workers = workers(),
      .size = h.size(),
      .unknowns = shared_.unknowns,
      .weights = op(level).weights(),
      .stiffness = constraints_ ? std::span(constraints_->stiffness()) : std::span<const double>{},
      .hats = hats.get(),
      .couples = nullptr,
      .target = [&](std::size_t v) { return Vector(constraints_->target(v)); },
      .residual = residual,
      .solve = [&](const PcgLimits& now,
                   const LinearSystem& linear) { return hierarchy_->solve(index, now, linear); },
      .restrict_to_vertices = op(level).penalty() ? Restriction{} : restriction,
      .set_weights = [&](const VertexWeights&) { set_weights(level); },
      .energy = [&](const double*) { return about.energy; }};
  Array<double> r(h.size());
  const LevelSolve solved =
      HeldSolve<1>(system, held_limits(level, about.functional), constraints, held, report)
          .run(h.data(), r.data());
  report.iterations = solved.iterations;
  constraint_force.assign(h.size(), 0.0);
  if (hats) hats->add_loads(held.loads, constraint_force.data());
  if (constraints_) held.bounds = constraints_->ends();
  const VertexWeights& weights = op(level).weights();
  for (std::size_t v = 0; v < weights.size(); ++v)
    if (shared_.unknowns.vertex[v] && !(hats && hats->under(v)))
      constraint_force[v] += weights[v] * (constraints_->target(v) - h[v]);
  return solved;
}

}  // namespace fairing
