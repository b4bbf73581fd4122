// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/pcg.h"

#include <algorithm>
#include <cmath>

#include "parallel/reductions.h"

namespace fairing {
namespace {

// For the error estimate: the largest ratio of gains that is used (with it the error is three times
// the last gain), and the ratio before there are two gains.
constexpr double largest_gain_ratio = 0.9, usual_gain_ratio = 0.5;

// Estimates the remaining error in the energy norm from the latest steps' gains of its square
// [Hestenes and Stiefel 1952]: from the last gain and the larger of the last two ratios of gains.
class EnergyError {
 public:
  void gained(double square) {
    before_ = last_ > 0 ? ratio_ : 0;
    ratio_ = last_ > 0 ? std::min(square / last_, largest_gain_ratio) : usual_gain_ratio;
    last_ = square;
  }
  double estimate() const {
    const double ratio = std::max(ratio_, before_);
    return std::sqrt(std::max(0.0, last_ * ratio / (1 - ratio)));
  }

 private:
  double last_ = 0, ratio_ = usual_gain_ratio, before_ = 0;
};

class Iteration {
 public:
  Iteration(VCycle& cycle, std::size_t top, Workers& workers, const PcgLimits& limits,
            const LinearSystem& system, PcgState& state)
      : cycle_(cycle),
        level_(cycle.levels[top]),
        top_(top),
        workers_(workers),
        limits_(limits),
        system_(system),
        size_(level_.op->size()),
        direction_(state.direction),
        product_(state.product) {
    for (Array<double>* each : {&direction_, &product_})
      if (each->size() < size_) each->resize(size_);
  }

  PcgResult run(const std::function<bool(const PcgResult&)>& each) {
    length_ = norm(workers_, size_, system_.r);
    result_.residual_scale = limits_.from_start ? length_ : limits_.residual_scale;
    result_.energy_scale = limits_.from_start ? 0 : limits_.energy_scale;
    result_.residual = relative(length_);
    result_.history.push_back(result_.residual);
    if (length_ <= limits_.noise) {
      result_.converged = true;
      return result_;
    }
    while (step() && !result_.converged && result_.iterations < limits_.max_iterations &&
           each(result_)) {
    }
    result_.residual = relative(length_);
    return result_;
  }

 private:
  double relative(double length) const { return limits_.relative(length, result_.residual_scale); }

  bool small_enough() {
    const double error = error_left_.estimate();
    result_.residual = relative(length_);
    result_.energy_error = result_.energy_scale > 0 ? error / result_.energy_scale : 0.0;
    return length_ <= limits_.noise || is_enough(error) ||
           (residual_will_do() && result_.energy_error <= limits_.tolerance);
  }

  bool residual_will_do() const {
    return limits_.by_error || result_.residual <= limits_.tolerance;
  }

  bool is_enough(double error) {
    result_.enough = length_ <= limits_.enough * limits_.residual_scale &&
                     error <= limits_.enough * limits_.energy_scale;
    return result_.enough;
  }

  // Judges by the error that the preconditioner sees at the start.
  bool is_done_before(double error) {
    if (limits_.from_start) result_.energy_scale = error;
    result_.energy_error = result_.energy_scale > 0 ? error / result_.energy_scale : 0.0;
    result_.converged =
        is_enough(error) || (residual_will_do() && result_.energy_error <= limits_.tolerance);
    return result_.converged;
  }

  // z <- M^-1 r, in units of the residual's length: single precision has a short range.
  const float* precondition() {
    float* to = level_.state.residual.data();
    for_each_index(workers_, size_, [&](std::size_t i) { to[i] = float(system_.r[i] / length_); });
    if (!system_.between || cycle_.solves(top_)) {
      cycle_.run(top_);
    } else {
      // Each cycle is the transpose of the other. S adds to the end of the first one, and the
      // second one smooths the result. (Measured: without a step at its end bob takes 119
      // iterations, with these 46; with as many as at the beginning 43, but longer ones.)
      const int few = std::max(1, cycle_.degree / 6);
      cycle_.run(top_, cycle_.degree, few);
      system_.between(level_.state.x.data(), level_.state.residual.data());
      cycle_.run(top_, few, cycle_.degree);
    }
    return level_.state.x.data();  // only now, since the smoother swaps its vectors
  }

  bool step() {
    const float* z = precondition();
    const double unit = length_;
    double *const r = system_.r, *const p = direction_.data(), *const q = product_.data();
    const double rz = unit * sum(workers_, size_, [&](std::size_t i) { return r[i] * z[i]; });
    result_.seen.push_back(std::sqrt(std::max(0.0, rz)));
    if (result_.iterations == 0 && is_done_before(result_.seen[0])) return false;
    // A new preconditioner starts a new sequence of conjugate directions.
    const bool fresh = result_.iterations == 0 || cycle_.degree != last_.degree;
    last_.degree = cycle_.degree;
    // Flexible beta: z.(r - r_old) / (z_old.r_old), and r - r_old is -step q.
    const double beta =
        fresh ? 0.0 : -last_.length * unit * sum(workers_, size_, [&](std::size_t i) {
          return z[i] * q[i];
        }) / last_.rz;
    last_.rz = rz;
    const double pr = sum(workers_, size_, [&](std::size_t i) {
      p[i] = fresh ? unit * z[i] : unit * z[i] + beta * p[i];
      return p[i] * r[i];
    });
    level_.op->apply(p, q);
    const double pq = sum(workers_, size_, [&](std::size_t i) { return p[i] * q[i]; });
    if (!(pq > 0) || !std::isfinite(pq)) {  // rounding leaves nothing to gain
      result_.broke_down = true;
      return false;
    }
    last_.length = pr / pq;
    length_ = std::sqrt(sum(workers_, size_, [&](std::size_t i) {
      system_.x[i] += last_.length * p[i];
      r[i] -= last_.length * q[i];
      return r[i] * r[i];
    }));
    error_left_.gained(last_.length * pr);
    ++result_.iterations;
    result_.converged = small_enough();
    result_.history.push_back(result_.residual);
    return true;
  }

  VCycle& cycle_;
  CycleLevel& level_;
  std::size_t top_;
  Workers& workers_;
  const PcgLimits& limits_;
  const LinearSystem& system_;
  std::size_t size_;
  Array<double>&direction_, &product_;  // and K times the direction
  struct {
    double rz = 0, length = 0;
    int degree = 0;  // of the smoother
  } last_;           // of the previous step

  PcgResult result_;
  double length_ = 0;  // of the residual
  EnergyError error_left_;
};

}  // namespace

PcgResult conjugate_gradients(VCycle& cycle, std::size_t top, Workers& workers,
                              const PcgLimits& limits, const LinearSystem& system, PcgState& state,
                              const std::function<bool(const PcgResult&)>& each) {
  return Iteration(cycle, top, workers, limits, system, state).run(each);
}

}  // namespace fairing
