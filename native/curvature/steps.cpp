// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/steps.h"

#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "constraints/anderson.h"
#include "curvature/error_estimate.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// A step that does not help at an eighth of its length has the wrong direction: more damping is
// worth more than another linearization after a shorter step.
constexpr double least_length = 1.0 / 8;

// Share of the energy that two successive damped steps have to gain.
constexpr double worthwhile_gain = 0.005;
// Share of the decrement by which damped steps may raise the energy. Near the end correct steps do,
// since the solution of the equation is not exactly the minimum of the discrete energy.
constexpr double allowed_rise = 0.1;

// Number of steps that the acceleration uses. Steps to least total curvature are accelerated once
// they settle, since each then leaves a fixed share of the error; steps to minimum variation below
// damped_decrement (measured: earlier, a creature's do not converge).
constexpr std::size_t accelerated_steps = 3;

// For minimum variation: K has this share of W, relative to both energies, times the last step's
// decrement (measured: without it a creature's steps do not settle).
constexpr double share_of_curvature = 0.1;

// Near a sphere the variation vanishes, and decrements relative to it mean nothing: they are
// relative to the variation plus this share of the mean squared curvature.
constexpr double flat_share = 1e-4;

// The integral of |M|^2, and the area.
struct Bending {
  double square, area;
};

Bending bending_of(const LinearizedSurface& surface, Workers& workers) {
  const Array<float>& shape = surface.linearization.shape;
  const auto area = [&](std::size_t i) { return area_of(&shape[4 * i]); };
  const auto energy = [&](std::size_t i) { return area(i) * square_of(&shape[4 * i]); };
  return {sum(workers, shape.size() / 4, energy), sum(workers, shape.size() / 4, area)};
}

// Repeats: solve for a direction, find the longest acceptable length, move.
class StepLoop {
 public:
  // `damping` is null for plain steps. `patience`: steps to reach plain_decrement; 0: any.
  StepLoop(SurfaceIterate& iterate, const Functional& functional, LocalDamping* damping,
           const StopCriterion& end, int patience)
      : it_(iterate),
        damping_(damping),
        end_(end),
        patience_(patience),
        anderson_(
            accelerated_steps, [this](const Array<double>& a) { return product(a); },
            [this](std::size_t size, const Array<double>& a, const Array<double>& b) {
              return sum(it_.workers(), size, [&](std::size_t i) { return a[i] * b[i]; });
            }),
        remainder_(iterate.system.error_reduction(iterate.level, functional)) {
    it_.trial.points.resize(3 * it_.grid().size());
    it_.ensure_linearized(functional);
    flat_ = flat_energy_about(it_.current, it_.workers());
  }

  // Takes steps until an end or `most` trials. Adds every step to report.steps; a rejected one has
  // length 0, after which damped steps go on with more damping.
  void run(int most, CurvatureLevelReport& report) {
    report.last_steps = 0;
    while (report.last_steps < most && is_bent(report)) {
      it_.system.report_progress(it_.level, report.steps.size());
      ++report.last_steps;
      StepReport& step = report.steps.emplace_back();
      find_step(step);
      if (finds_length(step)) {
        if (is_last(step, report)) return;
      } else {
        reject();
        if (!damping_) return;
      }
    }
  }

 private:
  // False if there is no energy left to lower.
  bool is_bent(CurvatureLevelReport& report) const {
    report.converged = it_.current.energy < flat_energy;
    if (report.converged) report.left = 0;
    return !report.converged && std::isfinite(it_.current.energy);
  }

  // Rejects an energy that is not finite.
  bool finds_length(StepReport& step) {
    for (step.length = 1; step.length >= least_length; step.length /= 2) {
      const double energy = try_length(step);
      if (std::isfinite(energy) && std::isfinite(step.movement) && is_acceptable(step, energy))
        return true;
    }
    step.length = 0;
    return false;
  }

  void find_step(StepReport& step) {
    if (!varies()) held_ = it_.current.held;
    if ((damping_ && !varies()) || it_.needs_coarse_levels(remainder_.last_decrement()))
      it_.system.linearize_below(it_.level, it_.current);
    it_.system.set_damping(it_.level, damping_ ? damping_->mu() : Array<float>{},
                           varies() ? share_for_long_waves() : 0);
    step.variation = varies();
    step.energy = it_.current.energy;
    const double gain = it_.system.solve(it_.level, it_.current, it_.step, held_, step);
    const double share = gain / scale();
    const bool is_of_use = share > -plain_decrement * plain_decrement;  // or rounding
    step.decrement =
        is_of_use ? std::sqrt(std::max(share, 0.0)) : std::numeric_limits<double>::infinity();
    if (step.decrement < (varies() ? damped_decrement : settling_decrement)) accelerate();
    if (damping_) it_.op().predict(it_.current.linearization.shape, it_.step.data(), predicted_);
  }

  // The potential is the energy minus the work of the loads; a step on pads lowers it.
  double try_length(StepReport& step) {
    const double energy = it_.try_step(step.length);
    step.movement = it_.movement(step.length);
    const bool judges = damping_ && step.length == 1 && (is_checked(step) || end_.decrement == 0);
    if (judges && damping_->judge(predicted_, it_.current.linearization, it_.trial.linearization,
                                  rejected_, accepted_, step.decrement))
      anderson_.forget();
    const double potential = energy - 2 * step.length * step.load_work;
    gain_ = it_.current.energy - potential;
    return potential;
  }

  bool is_acceptable(const StepReport& step, double energy) const {
    return !is_checked(step) ||
           !(energy > it_.current.energy + allowed_rise * step.decrement * scale());
  }

  // Moves to the latest trial. Returns whether it is the end.
  bool is_last(const StepReport& step, CurvatureLevelReport& report) {
    ++accepted_;
    if (step.length != 1) anderson_.took_share(step.length);
    std::swap(it_.current, it_.trial);
    if (!varies()) it_.current.held = held_;
    report.left = remainder_.after(step.decrement, step.movement / step.length, step.solved);
    report.converged = end_.is_reached(step.decrement, report.left);
    if (it_.system.is_bound()) report.constraint_gap = step.constraint_gap;
    report.converged &= step.constraint_gap <= it_.system.wanted_gap(it_.level);
    const bool too_late =
        patience_ > 0 && accepted_ >= patience_ && step.decrement > plain_decrement;
    flat_ = flat_energy_about(it_.current, it_.workers());
    return report.converged || too_late || leads_nowhere(step);
  }

  void reject() {
    ++rejected_;
    anderson_.forget();
    it_.linearize();
    remainder_.forget();
  }

  bool varies() const {
    return it_.current.functional.energy == CurvatureEnergy::minimum_variation;
  }
  // Decrements are relative to this energy.
  double scale() const { return it_.current.energy + flat_; }

  // The variation is insensitive to long waves, the matrix of total curvature is not. Its share is
  // proportional to the last decrement.
  double share_for_long_waves() {
    const double last = remainder_.last_decrement() > 0 ? remainder_.last_decrement() : 1;
    return share_of_curvature * last * scale() / bending_of(it_.current, it_.workers()).square;
  }

  // Accelerates the loads too: those of a plain step lag behind the surface, and the next step
  // would correct that. The loads of the first step are fitted, and have no change yet.
  void accelerate() {
    const NormalLoads& before = it_.current.held.loads;
    const bool with_loads = !varies() && !damping_ && !it_.system.is_bound();
    if (with_loads && before.size() != held_.loads.size()) return anderson_.forget();
    const std::size_t points = it_.step.size(), loads = with_loads ? before.size() : 0;
    it_.step.reserve(points + loads);
    for (std::size_t v = 0; v < loads; ++v) it_.step.push_back((held_.loads[v] - before[v])[0]);
    it_.step = anderson_.change(it_.step);
    for (std::size_t v = 0; v < loads; ++v) held_.loads[v][0] = before[v][0] + it_.step[points + v];
    it_.step.resize(points);
  }

  // Steps have the norm of the operator, linearized at the start of the latest step. Loads are
  // extrapolated with them but are not in the norm, since they follow from the surface.
  Array<double> product(const Array<double>& step) const {
    Array<double> out(it_.grid().size());
    it_.op().apply(step.data(), out.data());
    return out;
  }

  // Whether steps have climbed too long, or damped ones gain next to nothing. The work of the
  // loads differs from step to step, so changes of the potential are summed.
  bool leads_nowhere(const StepReport& step) {
    if (step.decrement < damped_decrement) return false;
    gained_ += gain_;
    const double last = std::exchange(last_gain_, gain_);
    if (end_.gain > 0)
      return ++damped_ > 1 && step.decrement < settling_decrement &&
             last + gain_ < end_.gain * it_.current.energy;
    climbed_ = gained_ > most_gained_ ? 0 : climbed_ + 1;
    most_gained_ = std::max(most_gained_, gained_);
    return climbed_ >= longest_climb;
  }

  // Closer to the end the energy is too inaccurate to judge a step.
  bool is_checked(const StepReport& step) const {
    return damping_ && !(step.decrement < damped_decrement);
  }

  SurfaceIterate& it_;
  LocalDamping* damping_;
  StopCriterion end_;
  int patience_;
  Anderson anderson_;
  Array<float> predicted_;
  Multipliers<1> held_;  // of the latest step
  ErrorEstimate remainder_;
  double flat_ = 0;  // energy that counts as zero
  // Changes of the potential: of the latest trial, the last step, all steps; the largest sum so
  // far.
  double gain_ = 0, last_gain_ = 0, gained_ = 0, most_gained_ = 0;
  int accepted_ = 0, rejected_ = 0, climbed_ = 0, damped_ = 0;  // numbers of steps
};

}  // namespace

double flat_energy_about(const LinearizedSurface& surface, Workers& workers) {
  if (surface.functional.energy != CurvatureEnergy::minimum_variation) return 0;
  const Bending bending = bending_of(surface, workers);
  return bending.area > 0 ? flat_share * bending.square / bending.area : 0;
}

bool is_near(const CurvatureLevelReport& report, double decrement) {
  if (report.converged || report.steps.empty()) return report.converged;
  const StepReport& last = report.steps.back();
  return last.length > 0 && last.decrement <= decrement;
}

namespace {

void run_steps(SurfaceIterate& iterate, const Pads* pads, LocalDamping* damping,
               const StopCriterion& end, int patience, CurvatureLevelReport& report) {
  // Local damping compares tensors in space, so it needs the charts' axes.
  StepLoop(iterate, {CurvatureEnergy::total_curvature, pads, damping != nullptr}, damping, end,
           patience)
      .run(iterate.system.options().max_steps, report);
  report.energy = iterate.op().objective();
}

}  // namespace

void run_to_variation(SurfaceIterate& iterate, const StopCriterion& end,
                      CurvatureLevelReport& report) {
  LocalDamping damping(iterate.grid(), iterate.system.shared().unknowns, iterate.workers());
  const std::size_t before = report.steps.size();
  try {
    StepLoop(iterate, of_variation, &damping, end, 0)
        .run(iterate.system.options().max_steps, report);
  } catch (const FairingError& error) {
    // The variation may leave vertices undetermined that only its long waves move; then its matrix
    // has no factor, and the present surface is the result
    if (error.code != ErrorCode::underdetermined) throw;
    report.steps.pop_back();
    --report.last_steps;
    report.converged = false;
    if (report.steps.size() == before) report.left = std::numeric_limits<double>::infinity();
  }
}

void run_plain(SurfaceIterate& iterate, const Pads* pads, const StopCriterion& end,
               CurvatureLevelReport& report) {
  run_steps(iterate, pads, nullptr, end, plain_patience, report);
}

void run_damped(SurfaceIterate& iterate, const StepStart& start, const Array<float>& filled,
                CurvatureLevelReport& report) {
  iterate.current = {};
  iterate.current.points = start.points;
  iterate.current.held = start.held;
  report = start.report;
  report.damped = true;
  LocalDamping damping(iterate.grid(), iterate.system.shared().unknowns, iterate.workers());
  if (!filled.empty()) damping.hold(filled);
  run_steps(iterate, nullptr, &damping, {damped_decrement, 0, worthwhile_gain}, 0, report);
}

void polish(SurfaceIterate& iterate, int patience, CurvatureLevelReport& report) {
  LinearizedSurface before = iterate.current;
  CurvatureLevelReport after = report;
  after.converged = false;
  run_steps(iterate, before.functional.pads, nullptr, accurate_end(iterate), patience, after);
  if (is_near(after, plain_decrement) && after.energy <= equal_energy * before.energy)
    report = std::move(after);
  else
    iterate.current = std::move(before);
}

}  // namespace fairing
