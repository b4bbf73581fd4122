// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/pcg.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "parallel/reductions.h"

namespace fairing {
namespace {

// The residual is computed from x again when it falls below this share of the last computed one;
// single precision has enough digits for some further steps.
constexpr double replaced_below = 1e-2;

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

template <class T>
T* room(Array<T>& a, std::size_t size) {
  if (a.size() < size) a.resize(size);
  return a.data();
}

// T: of the iteration's vectors. In single precision, whose range is short, they hold residual /
// unit.
template <class T>
class Iteration {
 public:
  static constexpr bool is_single = std::is_same_v<T, float>;

  Iteration(VCycle& cycle, std::size_t top, Workers& workers, const PcgLimits& limits,
            const LinearSystem& system, PcgState& state)
      : cycle_(cycle),
        level_(cycle.levels[top]),
        top_(top),
        workers_(workers),
        limits_(limits),
        system_(system),
        size_(level_.op->size()) {
    const std::size_t size = size_ + vector_room;
    if constexpr (is_single) {
      v_.r = room(state.rest, size);
      v_.p = room(state.fast_direction, size);
      v_.q = room(state.fast_product, size);
      v_.e = room(state.correction, size);
    } else {
      v_.r = system.r;
      v_.p = room(state.direction, size);
      v_.q = room(state.product, size);
    }
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
    if constexpr (is_single) scale_residual();
    while (step() && !result_.converged && result_.iterations < limits_.max_iterations &&
           each(result_)) {
    }
    if (is_single && drifted_) replace();
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

  // z <- M^-1 r; z is in units of z_unit_.
  const float* precondition() {
    // The preconditioner works on a residual of order one.
    z_unit_ = is_single ? 1 : length_;
    float* to = level_.state.residual.data();
    for_each_index(workers_, size_, [&](std::size_t i) { to[i] = float(v_.r[i] / z_unit_); });
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
    const double rz =
        z_unit_ * sum(workers_, size_, [&](std::size_t i) { return double(v_.r[i]) * z[i]; });
    if (result_.iterations == 0 && is_done_before(unit_ * std::sqrt(std::max(0.0, rz))))
      return false;
    // A new preconditioner starts a new sequence of conjugate directions.
    const bool fresh = result_.iterations == 0 || cycle_.degree != last_.degree;
    last_.degree = cycle_.degree;
    // Flexible beta: z.(r - r_old) / (z_old.r_old), and r - r_old is -step q.
    const double beta =
        fresh ? 0.0 : -last_.length * z_unit_ * sum(workers_, size_, [&](std::size_t i) {
          return double(z[i]) * v_.q[i];
        }) / last_.rz;
    last_.rz = rz;
    const T momentum = T(beta), unit = T(z_unit_);
    const double pr = sum(workers_, size_, [&](std::size_t i) {
      v_.p[i] = fresh ? unit * T(z[i]) : unit * T(z[i]) + momentum * v_.p[i];
      return double(v_.p[i]) * v_.r[i];
    });
    level_.op->apply(v_.p, v_.q);
    const double pq =
        sum(workers_, size_, [&](std::size_t i) { return double(v_.p[i]) * v_.q[i]; });
    if (!(pq > 0) || !std::isfinite(pq)) {  // rounding leaves nothing to gain
      result_.broke_down = true;
      return false;
    }
    last_.length = pr / pq;
    go(T(last_.length));
    error_left_.gained(unit_ * unit_ * last_.length * pr);
    ++result_.iterations;
    result_.converged = small_enough();
    if (is_single && (result_.converged || length_ < replaced_below * unit_)) {
      replace();
      result_.converged = small_enough();
    }
    result_.history.push_back(result_.residual);
    return true;
  }

  void go(T step) {
    const double square = sum(workers_, size_, [&](std::size_t i) {
      if constexpr (is_single)
        v_.e[i] += step * v_.p[i];
      else
        system_.x[i] += step * v_.p[i];
      v_.r[i] -= step * v_.q[i];
      return double(v_.r[i]) * v_.r[i];
    });
    length_ = unit_ * std::sqrt(square);
    drifted_ = true;
  }

  void scale_residual() {
    unit_ = length_ > 0 ? length_ : 1;
    for_each_index(workers_, size_, [&](std::size_t i) {
      v_.r[i] = T(system_.r[i] / unit_);
      v_.e[i] = 0;
    });
  }

  // Adds the correction to x, and changes all vectors to the unit of the present residual.
  void replace() {
    for_each_index(workers_, size_,
                   [&](std::size_t i) { system_.x[i] += unit_ * double(v_.e[i]); });
    system_.residual(system_.x, system_.r);
    length_ = norm(workers_, size_, system_.r);
    const double last = unit_;
    scale_residual();
    const double change = last / unit_;
    for_each_index(workers_, size_, [&](std::size_t i) {
      v_.p[i] = T(change * v_.p[i]);
      v_.q[i] = T(change * v_.q[i]);
    });
    last_.rz *= change * change;
    drifted_ = false;
  }

  VCycle& cycle_;
  CycleLevel& level_;
  std::size_t top_;
  Workers& workers_;
  const PcgLimits& limits_;
  const LinearSystem& system_;
  std::size_t size_;
  // The residual, the direction, K times the direction, and the correction not yet added to x.
  struct {
    T *r, *p, *q, *e = nullptr;
  } v_;
  struct {
    double rz = 0, length = 0;
    int degree = 0;  // of the smoother
  } last_;           // of the previous step

  PcgResult result_;
  double length_ = 0, unit_ = 1, z_unit_ = 1;  // length: of the residual, in the caller's unit
  EnergyError error_left_;
  bool drifted_ = false;  // since the residual was computed from x
};

}  // namespace

PcgResult conjugate_gradients(VCycle& cycle, std::size_t top, Workers& workers,
                              const PcgLimits& limits, const LinearSystem& system, PcgState& state,
                              const std::function<bool(const PcgResult&)>& each) {
  if (cycle.levels[top].op->single_precision_suffices())
    return Iteration<float>(cycle, top, workers, limits, system, state).run(each);
  return Iteration<double>(cycle, top, workers, limits, system, state).run(each);
}

}  // namespace fairing
