// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/variation.h"

#include <cmath>
#include <limits>
#include <utility>

#include "curvature/left_to_move.h"
#include "curvature/local_damping.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// As for total curvature (steps.cpp); decrements are smaller here, where every step is damped.
constexpr double allowed_rise = 0.1;
constexpr double least_judged_decrement = 1e-3;

// nu: where nothing is known of the surface; after a step that gained more than good_gain of what
// was predicted, one that had to be shortened, one that was rejected.
constexpr double first_nu = 0.1, least_nu = 1e-6;
constexpr double good_gain = 0.5, decay = 0.25, shortened = 2, rejected = 4;

// Where the linear solves end too early for a step to lessen the decrement by half, the next ones
// would gain as little.
constexpr double stuck = 0.5;

// Near a sphere nothing varies, and decrements relative to nothing say nothing: the energy is
// measured against itself and this share of the mean squared curvature.
constexpr double flat_share = 1e-4;

// The integral of |M|^2, and the area.
struct Bending {
  double square, area;
};

Bending bending_of(const Array<float>& shape, Workers& workers) {
  const std::size_t points = shape.size() / 4;
  Bending out;
  out.square = sum(workers, points, [&](std::size_t i) {
    const float* m = &shape[4 * i];
    return double(m[3]) * m[3] * (double(m[0]) * m[0] + double(m[1]) * m[1] + double(m[2]) * m[2]);
  });
  out.area = sum(workers, points,
                 [&](std::size_t i) { return double(shape[4 * i + 3]) * shape[4 * i + 3]; });
  return out;
}

class VariationStep final : public StepMethod {
 public:
  VariationStep(SurfaceIterate& iterate, const StepEnd& end, double& nu, const Bending& bending)
      : it_(iterate),
        end_(end),
        nu_(nu),
        damping_(iterate.grid(), iterate.system.shared().unknowns, iterate.workers()),
        bending_(bending),
        remainder_(iterate.system.share_left(iterate.level, of_variation)) {
    it_.trial.points.resize(3 * it_.grid().size());
    it_.linearize(of_variation);
  }

  bool begin(CurvatureLevelReport& report) override {
    if (!std::isfinite(it_.current.energy)) return false;
    it_.system.report_progress(it_.level, report.steps.size());
    return true;
  }

  void find_step(StepReport& step) override {
    scale_ = it_.current.energy + flat_share * bending_.square / bending_.area;
    const bool fresh = it_.needs_coarse_levels(remainder_.last_decrement());
    if (fresh) it_.system.linearize_below(it_.level, it_.current);
    for (int l = it_.system.base(); l <= it_.level; ++l)
      it_.system.op(l).take_share(nu_ * scale_ / bending_.square);
    it_.system.set_damping(it_.level, damping_.mu());
    step.variation = true;
    step.energy = it_.current.energy;
    predicted_gain_ =
        std::max(0.0, it_.system.solve(it_.level, it_.current, fresh, it_.step, not_held_, step));
    step.decrement = std::sqrt(predicted_gain_ / scale_);
    it_.op().predict(it_.current.linearization.shape, it_.step.data(), predicted_);
  }

  double try_length(StepReport& step, const StepCount& count) override {
    const double energy = it_.try_step(step.length);
    step.movement = it_.movement(step.length);
    if (step.length == 1)
      damping_.judge(predicted_, it_.current.linearization, it_.trial.linearization, count.rejected,
                     count.accepted, step.decrement);
    return energy;
  }

  bool is_acceptable(const StepReport& step, double energy) const override {
    return energy <= it_.current.energy + allowed_rise * step.decrement * scale_ ||
           step.decrement < least_judged_decrement;
  }

  bool accept(const StepReport& step, const StepCount& count,
              CurvatureLevelReport& report) override {
    const double gain =
        predicted_gain_ > 0 ? (it_.current.energy - it_.trial.energy) / predicted_gain_ : 1;
    std::swap(it_.current, it_.trial);
    if (step.length < 1)
      nu_ *= shortened;
    else if (gain > good_gain)
      nu_ = std::max(nu_ * decay, least_nu);
    bending_ = bending_of(it_.current.linearization.shape, it_.workers());
    const double before = remainder_.last_decrement();
    report.left = remainder_.after(step.decrement, step.movement / step.length, step.solved);
    // One step alone does not tell how much it has left, nor one that was held back.
    const bool tells = nu_ <= first_nu && (count.accepted > 1 || step.decrement <= plain_decrement);
    report.converged = tells && end_.is_reached(step.decrement, report.left);
    const bool is_stuck = !step.solved && before > 0 && step.decrement > stuck * before;
    return report.converged || is_stuck;
  }

  bool reject() override {
    nu_ = std::max(rejected * nu_, first_nu);
    remainder_.forget();
    it_.linearize();
    return true;
  }

 private:
  static constexpr Functional of_variation{CurvatureEnergy::minimum_variation, nullptr, true};

  SurfaceIterate& it_;
  StepEnd end_;
  double& nu_;
  LocalDamping damping_;
  Bending bending_;
  Array<float> predicted_;
  Multipliers<1> not_held_;
  double scale_ = 0;  // what decrements are relative to
  double predicted_gain_ = 0;
  LeftToMove remainder_;
};

}  // namespace

VariationSteps::VariationSteps(SurfaceIterate& iterate, const GaussNewtonOptions& options)
    : iterate_(iterate), options_(options), nu_(first_nu) {}

void VariationSteps::run(const StepEnd& end, CurvatureLevelReport& report) {
  const Bending bending = bending_of(iterate_.current.linearization.shape, iterate_.workers());
  if (!(bending.square > flat_energy)) return;
  const Array<double> start = iterate_.current.points;
  const Functional total_curvature = iterate_.current.functional;
  nu_ = std::min(nu_, first_nu);
  VariationStep method(iterate_, end, nu_, bending);
  report.start_variation = iterate_.current.energy;
  report.converged = report.kept_start = false;
  run_steps(method, options_.max_steps, report);
  report.variation = iterate_.current.energy;
  if (!(report.variation <=
        equal_energy * report.start_variation + flat_share * bending.square / bending.area)) {
    iterate_.current.points = start;
    report.variation = report.start_variation;
    report.left = std::numeric_limits<double>::infinity();
    report.converged = false;
    report.kept_start = true;
  }
  iterate_.linearize(total_curvature);
  report.energy = iterate_.op().fairness();
}

}  // namespace fairing
