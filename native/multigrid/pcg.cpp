// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/pcg.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "parallel/reductions.h"

namespace fairing {
namespace {

// The residual is computed anew from x where it has become so small a share of what it was the last
// time: single precision has digits enough for some steps more.
constexpr double replaced_below = 1e-2;

// Of the error's estimate: the largest ratio of gains that it believes (it then takes the error for
// three times the last gain), and the ratio before there are two gains.
constexpr double most_ratio = 0.9, first_ratio = 0.5;

// What is left of the error in the energy norm, from what the latest steps have gained of its
// square [Hestenes and Stiefel 1952]: the last gain, and the ratio at which gains fall, the worse
// of two.
class ErrorLeft {
 public:
  void gained(double square) {
    before_ = last_ > 0 ? ratio_ : 0;
    ratio_ = last_ > 0 ? std::min(square / last_, most_ratio) : first_ratio;
    last_ = square;
  }
  double estimate() const {
    const double ratio = std::max(ratio_, before_);
    return std::sqrt(std::max(0.0, last_ * ratio / (1 - ratio)));
  }

 private:
  double last_ = 0, ratio_ = first_ratio, before_ = 0;
};

template <class T>
T* room(Array<T>& a, std::size_t size) {
  if (a.size() < size) a.resize(size);
  return a.data();
}

// T: of the iteration's vectors. Those in single precision have no room for tiny units, and work on
// residual / unit.
template <class T>
class Iteration {
 public:
  static constexpr bool is_single = std::is_same_v<T, float>;

  Iteration(VCycle& cycle, std::size_t top, Workers& workers, const PcgLimits& limits,
            const Residual& residual, PcgState& state, double* x)
      : cycle_(cycle),
        level_(cycle.levels[top]),
        top_(top),
        workers_(workers),
        limits_(limits),
        residual_(residual),
        size_(level_.op->size()),
        true_r_(state.residual.data()),
        x_(x) {
    const std::size_t size = size_ + vector_room;
    if constexpr (is_single) {
      r_ = room(state.rest, size);
      p_ = room(state.fast_direction, size);
      q_ = room(state.fast_product, size);
      e_ = room(state.correction, size);
    } else {
      r_ = true_r_;
      p_ = room(state.direction, size);
      q_ = room(state.product, size);
    }
  }

  PcgResult run(const std::function<bool(const PcgResult&)>& each) {
    length_ = norm(workers_, size_, true_r_);
    residual_scale_ = limits_.from_start ? length_ : limits_.residual_scale;
    energy_scale_ = limits_.from_start ? 0 : limits_.energy_scale;
    result_.residual = relative(length_);
    result_.history.push_back(result_.residual);
    if (length_ <= limits_.noise) {
      result_.converged = true;
      return result_;
    }
    if constexpr (is_single) take_residual();
    while (step() && !result_.converged && result_.iterations < limits_.max_iterations &&
           each(result_)) {
    }
    if (is_single && drifted_) replace();
    result_.residual = relative(length_);
    result_.residual_scale = residual_scale_;
    result_.energy_scale = energy_scale_;
    return result_;
  }

 private:
  double relative(double length) const { return limits_.relative(length, residual_scale_); }

  bool small_enough() {
    const double error = error_left_.estimate();
    result_.residual = relative(length_);
    result_.energy_error = energy_scale_ > 0 ? error / energy_scale_ : 0.0;
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

  // From the error that the preconditioner sees at the start.
  bool is_done_before(double error) {
    if (limits_.from_start) energy_scale_ = error;
    result_.energy_error = energy_scale_ > 0 ? error / energy_scale_ : 0.0;
    result_.converged =
        is_enough(error) || (residual_will_do() && result_.energy_error <= limits_.tolerance);
    return result_.converged;
  }

  // z <- M^-1 r, where z stands for unit z.
  const float* precondition() {
    // The preconditioner works on a residual of order one.
    z_unit_ = is_single ? 1 : length_;
    float* to = level_.state.residual.data();
    for_each_index(workers_, size_, [&](std::size_t i) { to[i] = float(r_[i] / z_unit_); });
    cycle_.run(top_);
    return level_.state.x.data();  // only now: the smoother swaps its vectors
  }

  bool step() {
    const float* z = precondition();
    const double rz =
        z_unit_ * sum(workers_, size_, [&](std::size_t i) { return double(r_[i]) * z[i]; });
    if (result_.iterations == 0 && is_done_before(unit_ * std::sqrt(std::max(0.0, rz))))
      return false;
    // A new preconditioner starts a new sequence of conjugate directions.
    const bool fresh = result_.iterations == 0 || cycle_.degree != degree_;
    degree_ = cycle_.degree;
    // Flexible beta: z.(r - r_old) / (z_old.r_old), and r - r_old is -step q.
    const double beta =
        fresh ? 0.0 : -length_of_step_ * z_unit_ * sum(workers_, size_, [&](std::size_t i) {
          return double(z[i]) * q_[i];
        }) / rz_;
    rz_ = rz;
    const T momentum = T(beta), unit = T(z_unit_);
    const double pr = sum(workers_, size_, [&](std::size_t i) {
      p_[i] = fresh ? unit * T(z[i]) : unit * T(z[i]) + momentum * p_[i];
      return double(p_[i]) * r_[i];
    });
    level_.op->apply(p_, q_);
    const double pq = sum(workers_, size_, [&](std::size_t i) { return double(p_[i]) * q_[i]; });
    if (!(pq > 0) || !std::isfinite(pq)) {  // rounding leaves nothing to gain
      result_.broke_down = true;
      return false;
    }
    length_of_step_ = pr / pq;
    go(T(length_of_step_));
    error_left_.gained(unit_ * unit_ * length_of_step_ * pr);
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
        e_[i] += step * p_[i];
      else
        x_[i] += step * p_[i];
      r_[i] -= step * q_[i];
      return double(r_[i]) * r_[i];
    });
    length_ = unit_ * std::sqrt(square);
    drifted_ = true;
  }

  void take_residual() {
    unit_ = length_ > 0 ? length_ : 1;
    for_each_index(workers_, size_, [&](std::size_t i) {
      r_[i] = T(true_r_[i] / unit_);
      e_[i] = 0;
    });
  }

  // x takes the correction, and all vectors change to the unit of the residual that is left.
  void replace() {
    for_each_index(workers_, size_, [&](std::size_t i) { x_[i] += unit_ * double(e_[i]); });
    residual_(x_, true_r_);
    length_ = norm(workers_, size_, true_r_);
    const double last = unit_;
    take_residual();
    const double change = last / unit_;
    for_each_index(workers_, size_, [&](std::size_t i) {
      p_[i] = T(change * p_[i]);
      q_[i] = T(change * q_[i]);
    });
    rz_ *= change * change;
    drifted_ = false;
  }

  VCycle& cycle_;
  CycleLevel& level_;
  std::size_t top_;
  Workers& workers_;
  const PcgLimits& limits_;
  const Residual& residual_;
  std::size_t size_;
  double *true_r_, *x_;
  T *r_, *p_, *q_, *e_ = nullptr;  // e: what x still has to take

  PcgResult result_;
  double residual_scale_ = 0, energy_scale_ = 0;
  double length_ = 0, unit_ = 1, z_unit_ = 1;  // length: of the residual, in the caller's unit
  double rz_ = 0, length_of_step_ = 0;
  ErrorLeft error_left_;
  int degree_ = 0;
  bool drifted_ = false;  // since the residual was computed from x
};

}  // namespace

PcgResult conjugate_gradients(VCycle& cycle, std::size_t top, Workers& workers,
                              const PcgLimits& limits, const Residual& residual, PcgState& state,
                              double* x, const std::function<bool(const PcgResult&)>& each) {
  if (cycle.levels[top].op->single_precision_suffices())
    return Iteration<float>(cycle, top, workers, limits, residual, state, x).run(each);
  return Iteration<double>(cycle, top, workers, limits, residual, state, x).run(each);
}

}  // namespace fairing
