// SPDX-License-Identifier: GPL-3.0-or-later
// A Gauss-Newton step on pads: K h = force + Omega sum_c f_c phi_c with h_c = 0 at the control
// vertices, where nothing but the loads is to hold them: the force that is left there vanishes. The
// loads f act along the normals. Steps correct them, as hold/load_steps.h says.
#include <cmath>
#include <utility>

#include "curvature/system.h"
#include "hold/load_steps.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Each solve but the last leaves so much of the residual that it finds. The last one is to leave as
// much of what the first one found as a step without pads does, and gains so much at the least.
constexpr double solve_gain = 0.1, least_gain = 0.5;
// A step's loads are corrected until so much of the force is left that it began with, or of the
// loads; the next step begins with other loads anyway.
constexpr double force_gain = 0.1, force_tolerance = 1e-4;
constexpr int most_corrections = 6;

// Omega: the points' areas, with what else weighs the energy.
Array<double> areas_of(const Array<float>& shape, Workers& workers) {
  Array<double> areas(shape.size() / 4);
  for_each_index(workers, areas.size(), [&](std::size_t i) {
    areas[i] = double(shape[4 * i + 3]) * double(shape[4 * i + 3]);
  });
  return areas;
}

}  // namespace

bool GaussNewtonSystem::stand_on(const Pads* pads) {
  if (!pads) return false;
  if (pads_ && given_widths_ == pads->widths()) return false;
  pads_ = std::make_unique<Pads>(*pads);
  given_widths_ = pads->widths();
  shared_.pad_rows = &pads_->rows();
  return true;
}

// Those that leave the least of the whole force, over Omega: M f = -Phi^T force.
NormalLoads GaussNewtonSystem::fitting_loads(const Linearization& about) const {
  NormalLoads under = pads_->gather(about.force), loads;
  for (auto& force : under) force = -force;
  pads_->divide_by_mass<1>(under, loads);
  return loads;
}

LevelSolve GaussNewtonSystem::solve_on_pads(int level, const Linearization& about, Array<double>& h,
                                            NormalLoads& loads, Array<double>& force,
                                            StepReport& report) {
  const std::size_t points = grid(level).size();
  pads_->set_level(grid(level), areas_of(about.shape, workers()));
  if (loads.empty()) loads = fitting_loads(about);
  NormalLoads forces(loads.size(), NormalLoads::value_type::Zero()), correction, product;
  const auto load = [&] {
    force = about.force;
    pads_->add_loads(loads, force.data());
  };
  const Residual residual = [&](const double* x, double* r) {
    op(level).apply_on(pads_->rows(), x, r);
    for_each_index(workers(), points, [&](std::size_t i) { r[i] = force[i] - r[i]; });
    for (std::size_t v = 0; v < forces.size(); ++v)
      if (pads_->under(v)) forces[v][0] = -std::exchange(r[v], 0.0);
  };
  LoadSteps<1> steps(*pads_);
  Array<double>& r = hierarchy_.state().residual;
  double first_force = 0, first_residual = 0;
  const auto end = [&](const LevelSolve& solved) {
    Array<double> of_loads(points, 0.0);
    pads_->add_loads(loads, of_loads.data());
    report.load_work = sum(workers(), points, [&](std::size_t i) { return of_loads[i] * h[i]; });
    return solved;
  };
  bool last = false;
  load();
  residual(h.data(), r.data());
  for (;;) {
    const double now = norm(workers(), points, r.data());
    if (first_residual == 0) first_residual = now;
    PcgLimits goal = limits();
    goal.tolerance =
        last ? std::clamp(goal.tolerance * first_residual / now, goal.tolerance, least_gain)
             : solve_gain;
    const LevelSolve solved = hierarchy_.solve(std::size_t(level - base_), goal, residual, h.data(),
                                               [](const PcgResult&) {});
    report.iterations += solved.iterations;
    if (last) return end(solved);
    residual(h.data(), r.data());
    pads_->divide_by_mass<1>(forces, correction);
    pads_->multiply_mass<1>(loads, product);
    const double left = std::sqrt(std::max(0.0, dot<1>(correction, forces))),
                 size = std::sqrt(std::max(0.0, dot<1>(loads, product)));
    if (first_force == 0) first_force = left;
    last = left <= force_gain * first_force || left <= force_tolerance * size ||
           report.pad_corrections >= most_corrections;
    if (last && solved.direct) return end(solved);
    if (last) continue;
    const NormalLoads change = steps.change(correction);
    for (std::size_t v = 0; v < loads.size(); ++v) loads[v] += change[v];
    ++report.pad_corrections;
    load();
    residual(h.data(), r.data());
  }
}

}  // namespace fairing
