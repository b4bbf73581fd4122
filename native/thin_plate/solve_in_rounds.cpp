// SPDX-License-Identifier: GPL-3.0-or-later
// The plate, and what holds its control vertices, in turn. Each round solves for the surface with
// loads and aims as they are, and corrects these.
//
// Loads take what pads leave of the forces (hold/load_steps.h). A control vertex on a spring of
// weight w gives way: with s the stiffness of the surface there, the correction for a force r is
// (M + (s / w) T)^-1 (1 + s / w) r, with T the total of each hat.
//
// Tolerances are kept by springs whose aims HoldInSpace corrects.
//
// What a solve has left is foreseen (foresight.h), so that solves between corrections may be short.
//
// Couples take what is left of the slopes that fixed normals forbid (hold/couples.h), which is read
// off the surface.
//
// All corrections are accelerated as one: each shifts what the others have to do.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "hold/load_steps.h"
#include "parallel/reductions.h"
#include "thin_plate/foresight.h"
#include "thin_plate/run.h"

namespace fairing {
namespace {

constexpr int most_corrections = 32;  // a level

// Who asks for an exact surface gets exact loads.
double force_tolerance(double relative_residual) {
  return std::min(10 * std::sqrt(relative_residual), largest_force_left);
}

// What corrections are to take off, and how much of it one leaves: as much as a solve before two of them
// have said it.
struct Left {
  double now = 0, before = 0;
  double share = solve_gain;

  void take(double next) {
    before = std::exchange(now, next);
    if (before > 0 && now > 0) share = std::min(now / before, 1.0);
  }
};

}  // namespace

// One level's rounds.
struct ThinPlateSolver::Rounds {
  Run& run;
  int level;
  const PcgLimits& limits;
  HoldInSpace* constraint;  // or null

  const std::shared_ptr<const Hats> hats = run.solver.supports_.hats(level);  // null: point forces
  // null: no normal is fixed here
  const std::shared_ptr<const LevelCouples> couples = run.solver.supports_.couples(level);
  LoadSteps<3> steps = load_steps<3>(
      hats.get(), constraint ? constraint->comparable(hats.get()) : std::vector<double>{},
      couples ? couples->mass() : Moments{});
  Loads forces = Loads(run.state.loads.size(), Vec3::Zero());  // left at control vertices on pads
  Loads own_forces{};  // the same by the vertices' own rows, before anything is foreseen
  Foresight foresight{run.levels(), level, run.solver.supports_.stiffness()};
  Multipliers<3> correction{};
  Left force{}, gap{};  // forces and slopes together, in the norm of M
  double tilt = 0;      // of a tangent plane from a fixed one; a normal may look to the wrong side
  Run::Solved solved{run.report_of(level), {}};
  double gain = 0;  // of all solves, as a logarithm of residuals

  ThinPlateLevels& levels() { return run.levels(); }
  const Unknowns& unknowns() { return levels().shared().unknowns; }
  const VertexWeights& weights() { return levels().weights(level); }
  const ThinPlateOptions& options() const { return run.solver.options_; }
  LevelReport& report() { return solved.report; }
  double* x() { return run.x.data(); }
  std::span<const Vec3> targets() const {
    return constraint ? constraint->aims() : run.data.targets;
  }
  bool top() const { return level == run.top(); }
  double wanted_gap() const { return top() ? gap_wanted : coarse_gap; }

  // r <- Omega phi f + P goal - (K + P) x on the unknowns; the forces left at the control vertices apart.
  void residual(const double* x, double* r) {
    if (!hats) {
      levels().residual(level, targets(), run.goal, x, r);
    } else {
      levels().apply_with(level, hats->rows(), x, r);
      for_each_index(levels().workers(), run.size(level), [&](std::size_t i) { r[i] = -r[i]; });
      levels().add_pull(level, run.goal, r);
      hats->add_loads(run.state.loads, r);
      take_point_forces<3>(
          unknowns(), weights(), hats.get(), run.state.loads,
          [&](std::size_t v) { return Vec3(targets()[v] - Eigen::Map<const Vec3>(x + 3 * v)); },
          forces, r);
    }
    if (couples) couples->add(run.state.moments, r);
    for (std::size_t i = 0; i < run.forces.size(); ++i) r[i] += run.forces[i];
  }

  void take_residual() { residual(x(), run.r.data()); }

  // After a solve and a correction. The solve has left its residual, and where loads are all that
  // changes, theirs is added. Other corrections, and forces from outside, reach into the rows of
  // fixed vertices.
  void renew_residual(const Loads& change) {
    if (!hats || constraint || couples || !run.forces.empty()) return take_residual();
    Loads shift(forces.size(), Vec3::Zero());
    hats->add_loads(change, run.r.data());
    take_point_forces<3>(
        unknowns(), weights(), hats.get(), change, [](std::size_t) { return Vec3(Vec3::Zero()); },
        shift, run.r.data());
    for (std::size_t v = 0; v < forces.size(); ++v) forces[v] = own_forces[v] + shift[v];
  }

  // `whole`: as far as is asked.
  void solve(bool whole) {
    PcgLimits now = limits;
    if (!whole && !limits.from_start) {
      now.from_start = true;
      now.tolerance = std::max(limits.tolerance, solve_gain);
      // Afterwards something has to move: forces that are read again say nothing.
      if (!constraint && report().pad_corrections == 0) now.enough = limits.tolerance;
    }
    const Foresight::Seen before = foresight.before(run.r.data(), report().direct, forces);
    const double begun = norm(levels().workers(), run.size(level), run.r.data());
    const int iterations = report().iterations;
    const LevelSolve solve = levels().solve(
        level, now, {[&](const double* y, double* r) { residual(y, r); }, x(), run.r.data()},
        [&](const PcgResult& so_far) {
          // nobody knows how many iterations the rounds will take
          run.report_done(level, 1 - 1 / std::sqrt(1.0 + iterations + so_far.iterations));
        });
    static_cast<LevelSolve&>(report()) = solve;
    report().iterations += iterations;
    if (now.from_start && !limits.from_start)
      take_scale(limits.residual_scale > 0 ? begun / limits.residual_scale : 0.0);
    if (solve.iterations > 0 && solve.residuals.back() > 0)
      gain += std::log(solve.residuals.front() / solve.residuals.back());
    if (hats && !solve.direct && !levels().op(level).single_precision_suffices()) take_residual();
    own_forces = forces;
    foresight.foresee(before, x(), run.r.data(), solve.direct, hats.get(), forces);
  }

  // Residuals are reported relative to the control polyhedron's, however far a solve was to go.
  void take_scale(double scale) {
    report().residual *= scale;
    for (double& r : report().residuals) r *= scale;
  }

  double wanted_force() const {
    return std::max(run.rough_force, top() ? force_tolerance(options().solve.relative_residual)
                                           : coarse_force_tolerance);
  }
  double wanted_tilt() const { return largest_angle_left / largest_force_left * wanted_force(); }

  // Of the loads, and of their correction, in the norm of M: squares.
  struct Sizes {
    double left = 0, loads = 0;
  };
  Sizes correct_loads() {
    const Loads& loads = run.state.loads;
    Loads product;
    const std::vector<double> compliance_ratio =
        compliance_ratios(unknowns(), weights(), run.solver.supports_.stiffness(), *hats);
    hats->divide_by_mass<3>(forces, correction.loads, compliance_ratio);
    hats->multiply_mass<3>(loads, product);
    return {dot<3>(correction.loads, forces), dot<3>(loads, product)};
  }

  // Couples are tried out after a solve: the smoother is to know the whole of the surface first.
  Sizes correct_couples() {
    PlateSupports& supports = run.solver.supports_;
    if (!supports.compliance()) supports.measure_couples(level, options().solve.max_iterations);
    correction.moments = couples->correction(*supports.compliance(), x());
    report().normal_angle = tilt = 0;
    Sizes out;
    for (std::size_t c = 0; c < couples->size(); ++c) {
      const double angle = couples->angle(c, x());
      report().normal_angle = std::max(report().normal_angle, angle);
      tilt = std::max(tilt, std::min(angle, std::numbers::pi - angle));
      out.left += couples->mass()[c].dot(correction.moments[c].cwiseAbs2());
      out.loads += couples->mass()[c].dot(run.state.moments[c].cwiseAbs2());
    }
    return out;
  }

  // Whether little enough is left at the points, and of the angles to fixed normals; `correction`
  // has what would take it off.
  bool loads_settled() {
    if (!hats && !couples) return true;
    const Sizes of_loads = hats ? correct_loads() : Sizes{},
                of_couples = couples ? correct_couples() : Sizes{};
    const double size = std::sqrt(std::max(0.0, of_loads.loads + of_couples.loads));
    force.take(std::sqrt(std::max(0.0, of_loads.left + of_couples.left)));
    report().pad_force = size > 0 ? force.now / size : force.now > 0 ? 1.0 : 0.0;
    double force_norm = 0;
    for (const Vec3& f : forces) force_norm += f.squaredNorm();
    return tilt <= wanted_tilt() &&
           (report().pad_force <= wanted_force() || std::sqrt(force_norm) <= limits.noise);
  }
  bool bounds_settled() {
    if (!constraint) return true;
    const bool settled =
        constraint->settled(levels().energy(level, x()), wanted_gap(), foresight.vertices());
    gap.take(constraint->gap());
    return settled;
  }

  // Whether one more correction will settle all, as the last ones did, with as much to spare as a solve
  // leaves.
  bool nearly_settled() {
    return force.share * report().pad_force <= solve_gain * wanted_force() &&
           force.share * tilt <= solve_gain * wanted_tilt() &&
           gap.share * gap.now <= solve_gain * wanted_gap();
  }
  int corrections_left() {
    return most_corrections - std::max(report().pad_corrections, report().constraint_rounds);
  }

  void renew_springs() {
    constraint->renew(foresight.vertices());
    levels().set_weights(constraint->weights(), level);
    ++report().constraint_rounds;
  }

  // Returns how loads change.
  Loads correct() {
    if (constraint && constraint->need_renewal()) {
      renew_springs();
      steps.forget();
      return {};
    }
    if (constraint) {
      correction.bounds = constraint->correction(foresight.vertices(), forces);
      if (hats) correct_loads();
      ++report().constraint_rounds;
    }
    report().pad_corrections += hats || couples;
    Multipliers<3> step = steps.change(correction);
    for (std::size_t v = 0; v < step.loads.size(); ++v) run.state.loads[v] += step.loads[v];
    for (std::size_t c = 0; c < step.moments.size(); ++c) run.state.moments[c] += step.moments[c];
    if (constraint) constraint->change(step.bounds);
    return std::move(step.loads);
  }

  // Below the finest level what a solve leaves is less than what the next level changes. A correction
  // after the last solve may ask for less than that leaves: then nothing would move, and forces be read
  // that say nothing. So others go on with solves that gain.
  void run_rounds() {
    take_residual();
    for (bool whole = false;;) {
      solve(whole);
      const bool loads = loads_settled(), bounds = bounds_settled(), settled = loads && bounds;
      if (settled && !top()) return;
      if ((whole || report().enough) && (settled || corrections_left() <= 0)) {
        report().converged = report().converged && loads;
        return;
      }
      whole = settled || nearly_settled() || corrections_left() <= 1;
      renew_residual(settled ? Loads(run.state.loads.size(), Vec3::Zero()) : correct());
    }
  }

  Run::Solved solve_all() {
    report().constraint_rounds = constraint != nullptr;
    run_rounds();
    if (constraint) {
      constraint->enforce(x());
      report().constraint_gap = constraint->gap();
      report().converged = report().converged && report().constraint_gap <= wanted_gap();
    }
    // Couples hold a tangent plane, whichever of its sides the surface turns up.
    if (couples && top())
      report().converged = report().converged && report().normal_angle <= largest_angle_left;
    solved.equivalent = report();
    if (gain > 0)
      solved.equivalent.iterations = int(-report().iterations * std::log(limits.tolerance) / gain);
    return solved;
  }
};

ThinPlateSolver::Run::Solved ThinPlateSolver::Run::solve_in_rounds(int level,
                                                                   const PcgLimits& limits,
                                                                   HoldInSpace* constraint) {
  return Rounds{*this, level, limits, constraint}.solve_all();
}

}  // namespace fairing
