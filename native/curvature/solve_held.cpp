// SPDX-License-Identifier: GPL-3.0-or-later
// A Gauss-Newton step whose control vertices are held on pads, by weights or within tolerances:
// K h = force + Omega sum_c f_c phi_c, where nothing but the loads is to hold the vertices on pads:
// whatever other force they need vanishes. The loads f act along the normals. Solves correct them,
// and the multipliers of tolerances, as hold/load_steps.h and hold/hold_along_normals.h say.
#include <cmath>
#include <utility>

#include "curvature/system.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// What a step on the finest level leaves: each solve of what it finds, and corrections of the loads of
// the force that the step began with; the next step begins with other loads anyway (measured: of 0.1,
// 0.2, 0.3 and 0.5, bob, a hull and spheres take the least time with 0.2). Below it solves leave less,
// since where a coarse level ends decides where points lie along the surface, and loads more. Where
// control vertices may move, all leave `inexact`: ends hang on forces.
constexpr double left_on_finest = 0.2, force_left_below = 0.3;
// Loads that do not settle with their ends make steps that burst.
constexpr int most_load_corrections = 6;

// Omega: the points' areas, with what else weighs the energy.
Array<double> areas_of(const Array<float>& shape, Workers& workers) {
  Array<double> areas(shape.size() / 4);
  for_each_index(workers, areas.size(), [&](std::size_t i) {
    areas[i] = double(shape[4 * i + 3]) * double(shape[4 * i + 3]);
  });
  return areas;
}

}  // namespace

double GaussNewtonSystem::share_left(int level, const Functional& functional) const {
  return functional.pads && !hold_ && level == finest() ? left_on_finest : inexact;
}

void GaussNewtonSystem::let_go(Unknowns unknowns, int level, LinearizedSurface& surface) {
  hold_ = nullptr;
  shared_.unknowns = std::move(unknowns);
  for (const auto& op : operators_) op->set_weights({});
  linearize(level, surface);
  linearize_below(level, surface);
  hierarchy_->change_unknowns(std::size_t(level - base_));
}

void GaussNewtonSystem::take_weights(int level, bool spectrum) {
  for (int l = base_; l <= level; ++l) op(l).set_weights(hold_->weights());
  hierarchy_->refresh(std::size_t(level - base_), spectrum);
}

// The coarsest level's K knows control vertices alone.
void GaussNewtonSystem::look_along(const LinearizedSurface& about, const Multipliers<1>& held) {
  const Array<float>& diagonal = op(base_).diagonal();
  hold_->look_along(about.linearization.normal.data(), about.points.data(), held.bounds,
                    {diagonal.begin(), diagonal.begin() + std::ptrdiff_t(mesh().vertex_count())});
}

// One step's solves.
struct GaussNewtonSystem::HeldSolve {
  GaussNewtonSystem& system;
  int level;
  const LinearizedSurface& about;
  Array<double>& h;
  Multipliers<1>& held;
  Array<double>& force;  // the loads' part included
  StepReport& report;

  const std::unique_ptr<const Hats> hats =
      about.functional.pads
          ? std::make_unique<Hats>(*about.functional.pads, system.grid(level),
                                   areas_of(about.linearization.shape, system.workers()))
          : nullptr;
  NormalLoads forces{};  // left at the vertices on pads
  Multipliers<1> correction{};
  double first_force = 0, first_gap = 0;
  Array<double> r = Array<double>(h.size()), product = Array<double>(h.size(), 0.0);  // of h

  HoldAlongNormals* hold() const { return system.hold_; }  // or null
  const VertexWeights& weights() const { return system.op(level).weights(); }
  bool bounds() const { return hold() && hold()->active(); }
  std::size_t vertices() const { return std::size_t(system.mesh().vertex_count()); }

  // Those that leave the least of the whole force, over Omega: M f = -Phi^T force.
  NormalLoads fitting_loads() const {
    NormalLoads under = hats->gather(about.linearization.force), loads;
    for (auto& f : under) f = -f;
    hats->divide_by_mass<1>(under, loads);
    return loads;
  }

  void start() {
    if (hats && held.loads.empty()) held.loads = fitting_loads();
    forces.assign(held.loads.size(), NormalLoads::value_type::Zero());
    go_to_ends();
  }

  void go_to_ends() {
    for (std::size_t v = 0; bounds() && v < vertices(); ++v)
      if (hold()->on_end(v)) h[v] = hold()->way(v);
  }

  void load() {
    force = about.linearization.force;
    if (hats) hats->add_loads(held.loads, force.data());
  }

  // product <- K x without the weights.
  void multiply(const double* x) {
    system.op(level).apply_on(hats ? hats->rows() : system.shared_.unknowns, x, product.data());
  }

  // Of x, whose product is known.
  void take_residual(const double* x, double* out) {
    const CurvatureShared& shared = system.shared_;
    for_each_index(system.workers(), h.size(),
                   [&](std::size_t i) { out[i] = force[i] - product[i]; });
    take_point_forces<1>(
        shared.unknowns, weights(), hats.get(), held.loads,
        [&](std::size_t v) { return NormalLoads::value_type(hold()->way(v) - x[v]); }, forces, out);
  }

  // What the residual of a solve that is not exact rests on control vertices as, H^T r, with H their
  // prolongation: it belongs to their forces. Their own rows alone know only that of points beside
  // them (measured: a cube at level 7 ended 4e-4 off its sphere with one degree of the smoother).
  void foresee() {
    NormalLoads rest(vertices());
    restrict_to_vertices<1>(
        system.transfers_, level, hats->rows(), system.workers(), r,
        [this](int l) { return system.hierarchy_->room(std::size_t(l - system.base_)); }, rest);
    for (std::size_t v = 0; v < forces.size(); ++v)
      if (hats->under(v)) forces[v] -= rest[v];
  }

  LevelSolve solve() {
    PcgLimits goal = system.limits(about.functional);
    if (hats || bounds()) goal.tolerance = system.share_left(level, about.functional);
    const LevelSolve solved = system.hierarchy_->solve(
        std::size_t(level - system.base_), goal,
        {[this](const double* x, double* out) { multiply(x), take_residual(x, out); }, h.data(),
         r.data()},
        [](const PcgResult&) {});
    report.iterations += solved.iterations;
    if (!system.op(level).single_precision_suffices()) multiply(h.data());
    take_residual(h.data(), r.data());
    if (hats && !hold() && !solved.direct) foresee();
    return solved;
  }

  bool loads_settled() {
    if (!hats) return true;
    NormalLoads mass_of_loads;
    const std::vector<double> compliance_ratio =
        hold() ? compliance_ratios(system.shared_.unknowns, weights(), hold()->stiffness(), *hats)
               : std::vector<double>{};
    hats->divide_by_mass<1>(forces, correction.loads, compliance_ratio);
    hats->multiply_mass<1>(held.loads, mass_of_loads);
    const double left = std::sqrt(std::max(0.0, dot<1>(correction.loads, forces))),
                 size = std::sqrt(std::max(0.0, dot<1>(held.loads, mass_of_loads)));
    if (first_force == 0) first_force = left;
    const double tolerance =
        level == system.finest() ? system.load_tolerance_ : coarse_force_tolerance;
    const double gain = hold()                     ? inexact
                        : level == system.finest() ? left_on_finest
                                                   : force_left_below;
    return left <= gain * first_force || left <= tolerance * size;
  }

  bool bounds_settled() {
    if (!bounds()) return true;
    const double wanted = std::max(system.wanted_gap(level), inexact * first_gap);
    const bool settled = hold()->settled(about.energy, wanted, h.data());
    report.constraint_gap = hold()->gap();
    if (first_gap == 0) first_gap = hold()->gap();
    return settled;
  }

  // Other ends: another problem, of which earlier corrections tell nothing.
  bool turn() {
    if (!hold()->turn(h.data())) return false;
    ++report.constraint_rounds;
    system.take_weights(level, false);
    go_to_ends();
    return true;
  }

  void correct(LoadSteps<1>& steps) {
    if (!hats) return;
    const Multipliers<1> change = steps.change(correction);
    for (std::size_t v = 0; v < held.loads.size(); ++v) held.loads[v] += change.loads[v];
    ++report.pad_corrections;
  }

  LevelSolve end(const LevelSolve& solved) {
    Array<double> of_loads(h.size(), 0.0);
    if (hats) hats->add_loads(held.loads, of_loads.data());
    if (hold()) {
      held.bounds = hold()->sides();
      for (std::size_t v = 0; v < weights().size(); ++v) {
        if (!system.shared_.unknowns.vertex[v] || (hats && hats->under(v))) continue;
        const double spring = weights()[v] * (hold()->way(v) - h[v]);
        of_loads[v] += spring;
        force[v] += spring;
      }
    }
    report.load_work =
        sum(system.workers(), h.size(), [&](std::size_t i) { return of_loads[i] * h[i]; });
    return solved;
  }

  LevelSolve run() {
    start();
    LoadSteps<1> steps = load_steps<1>(hats.get());
    int corrections = 0;  // with these ends
    load();
    if (bounds()) multiply(h.data());  // else h is zero
    take_residual(h.data(), r.data());
    for (;;) {
      const LevelSolve solved = solve();
      // Only then do forces tell which ends are right.
      const bool settled = loads_settled() || corrections == most_load_corrections,
                 turned = !bounds_settled() && settled && turn();
      if (settled && !turned) return end(solved);
      correct(steps);
      ++corrections;
      if (turned) {
        corrections = 0;
        steps.forget();
      }
      load();
      if (turned) multiply(h.data());
      take_residual(h.data(), r.data());
    }
  }
};

LevelSolve GaussNewtonSystem::solve_held(int level, const LinearizedSurface& about,
                                         Array<double>& h, Multipliers<1>& held,
                                         Array<double>& force, StepReport& report) {
  return HeldSolve{*this, level, about, h, held, force, report}.run();
}

}  // namespace fairing
