// SPDX-License-Identifier: GPL-3.0-or-later
#include "constraints/held_solve.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/roundoff.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

template <int N>
LoadsOf<N> zeros(std::size_t count) {
  return LoadsOf<N>(count, LoadsOf<N>::value_type::Zero());
}

template <int N>
std::vector<double> bound_weights(const HeldSystem<N>& system,
                                  const typename HeldSolve<N>::Constraints* constraints) {
  if constexpr (N == 3)
    if (constraints) return constraints->comparable(system.hats);
  return {};
}

double dot_product(std::size_t size, const Array<double>& a, const Array<double>& b) {
  return std::inner_product(a.begin(), a.begin() + std::ptrdiff_t(size), b.begin(), 0.0);
}

}  // namespace

template <int N>
void HeldSolve<N>::Convergence::set(double next) {
  const double before = std::exchange(now, next);
  if (first == 0) first = next;
  if (before > 0 && now > 0) share = std::min(now / before, 1.0);
}

template <int N>
HeldSolve<N>::HeldSolve(const HeldSystem<N>& system, const HeldLimits& limits,
                        Constraints* constraints, Multipliers<N>& multipliers, HeldReport& report)
    : system_(system),
      limits_(limits),
      constraints_(constraints),
      multipliers_(multipliers),
      report_(report),
      bound_weights_(bound_weights<N>(system, constraints)),
      steps_(
          6, [this](const Array<double>& a) { return product(a); }, dot_product),
      forces_(zeros<N>(multipliers.loads.size())),
      vertices_(zeros<N>(system.unknowns.vertex.size())) {}

// Adds the forces that hold control vertices to their rows of r: for a fixed vertex the force of
// its row, for another its spring's w away(v), without the part that its pad has taken. On pads
// this becomes forces[v], for the loads. Then r is zero at fixed vertices, including those fixed
// after the pads were made.
template <int N>
template <class Away>
void HeldSolve<N>::add_springs(Away&& away, const LoadsOf<N>& loads, LoadsOf<N>& forces,
                               double* r) const {
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    Eigen::Map<Vector> row(r + N * v);
    if (!system_.unknowns.vertex[v]) {
      if (on_pad(v)) forces[v] = -row;
      row.setZero();
    } else if (!system_.weights.empty()) {
      Vector pull = system_.weights[v] * away(v);
      if (on_pad(v)) forces[v] = pull -= system_.hats->total(v) * loads[v];
      row += pull;
    }
  }
}

template <int N>
void HeldSolve<N>::compute_residual(const double* x, double* r) {
  system_.residual(x, r);
  if (system_.hats) system_.hats->add_loads(multipliers_.loads, r);
  if constexpr (N == 3)
    if (system_.couples) system_.couples->add(multipliers_.moments, r);
  add_springs(
      [&](std::size_t v) {
        return Vector(system_.target(v) - Eigen::Map<const Vector>(x + N * v));
      },
      multipliers_.loads, forces_, r);
}

template <int N>
void HeldSolve<N>::solve(bool whole) {
  PcgLimits now = limits_.solve;
  const bool is_short = !whole && !limits_.solve.from_start;
  if (is_short) {
    now.from_start = true;
    now.tolerance = std::max(now.tolerance, solve_gain);
    // After a correction the solve has to move something; otherwise the forces do not change.
    if (!constraints_ && iterations_ == 0) now.enough = limits_.solve.tolerance;
  }
  const double begun = norm(system_.workers, system_.size, r_);
  const int before = solved_.iterations;
  solved_ =
      system_.solve(now, {[this](const double* y, double* r) { compute_residual(y, r); }, x_, r_});
  if (solved_.iterations > 0 && solved_.residuals.size() > 1 && solved_.residuals.back() > 0)
    gain_ += std::log(solved_.residuals.front() / solved_.residuals.back());
  solved_.iterations += before;
  if (is_short) {
    const double scale =
        limits_.solve.residual_scale > 0 ? begun / limits_.solve.residual_scale : 0.0;
    solved_.residual *= scale;
    for (double& r : solved_.residuals) r *= scale;
  }
  if (system_.hats) compute_residual(x_, r_);
  own_forces_ = forces_;
  correct_by_residual(solved_.direct);
}

// Zero after a direct solve.
template <int N>
void HeldSolve<N>::correct_by_residual(bool direct) {
  for (std::size_t v = 0; v < vertices_.size(); ++v)
    vertices_[v] = Eigen::Map<const Vector>(x_ + N * v);
  if (direct || !system_.restrict_to_vertices || (!system_.hats && !constraints_)) return;
  LoadsOf<N> rest = zeros<N>(vertices_.size());
  system_.restrict_to_vertices({r_, system_.size}, rest);
  for (std::size_t v = 0; v < rest.size(); ++v) {
    const double w = spring(v);
    if (system_.unknowns.vertex[v]) rest[v] *= w > 0 ? w / (w + system_.stiffness[v]) : 0.0;
    if (on_pad(v)) forces_[v] -= rest[v];
    if (w > 0) vertices_[v] += rest[v] / w;
  }
}

// A spring much softer than the surface hardly changes its own load.
template <int N>
typename HeldSolve<N>::Sizes HeldSolve<N>::correct_loads() {
  std::vector<double> compliance;  // how much each spring gives way to its load: s / w
  for (std::size_t v = 0; v < system_.stiffness.size(); ++v) {
    const double w = spring(v), s = system_.stiffness[v];
    compliance.push_back(w > 0 && on_pad(v) ? std::min(w / roundoff, s) / w : 0.0);
  }
  const Hats& hats = *system_.hats;
  LoadsOf<N> product;
  hats.divide_by_mass<N>(forces_, correction_.loads, compliance);
  hats.multiply_mass<N>(multipliers_.loads, product);
  return {dot<N>(correction_.loads, forces_), dot<N>(multipliers_.loads, product)};
}

template <int N>
typename HeldSolve<N>::Sizes HeldSolve<N>::correct_couples() {
  const LevelCouples& couples = *system_.couples;
  correction_.moments = couples.correction(system_.compliance_of_couples(), x_);
  report_.normal_angle = tilt_ = 0;
  Sizes out;
  for (std::size_t c = 0; c < couples.size(); ++c) {
    const double angle = couples.angle(c, x_);
    report_.normal_angle = std::max(report_.normal_angle, angle);
    tilt_ = std::max(tilt_, std::min(angle, std::numbers::pi - angle));
    out.left += couples.mass()[c].dot(correction_.moments[c].cwiseAbs2());
    out.all += couples.mass()[c].dot(multipliers_.moments[c].cwiseAbs2());
  }
  return out;
}

// Whether the remaining forces, and the angles to fixed normals, are small enough; computes the
// correction for the rest.
template <int N>
bool HeldSolve<N>::check_loads() {
  if (!system_.hats && !system_.couples) return true;
  const Sizes loads = system_.hats ? correct_loads() : Sizes{},
              couples = system_.couples ? correct_couples() : Sizes{};
  const double all = std::sqrt(std::max(0.0, loads.all + couples.all));
  force_.set(std::sqrt(std::max(0.0, loads.left + couples.left)));
  report_.pad_force = all > 0 ? force_.now / all : force_.now > 0 ? 1.0 : 0.0;
  return tilt_ <= limits_.angle && (report_.pad_force <= limits_.force ||
                                    force_.now <= limits_.of_first_force * force_.first ||
                                    std::sqrt(dot<N>(forces_, forces_)) <= limits_.solve.noise);
}

template <int N>
bool HeldSolve<N>::check_bounds() {
  if (!constraints_) return true;
  const double wanted = std::max(limits_.gap, limits_.of_first_gap * gap_.first);
  const bool settled = constraints_->settled(system_.energy(x_), wanted, vertices_[0].data());
  gap_.set(constraints_->gap());
  report_.constraint_gap = constraints_->gap();
  return settled;
}

// Whether one more correction will satisfy all constraints at the rate of the last ones, with a
// margin for the error of a solve.
template <int N>
bool HeldSolve<N>::nearly_settled() const {
  return force_.share * report_.pad_force <= solve_gain * limits_.force &&
         force_.share * tilt_ <= solve_gain * limits_.angle &&
         gap_.share * gap_.now <= solve_gain * limits_.gap;
}

// By M for loads and moments; shifts of targets are scaled.
template <int N>
Array<double> HeldSolve<N>::product(const Array<double>& numbers) const {
  const Multipliers<N> of = multipliers_of(numbers, correction_);
  Multipliers<N> out = of;
  if (system_.hats) system_.hats->template multiply_mass<N>(of.loads, out.loads);
  for (std::size_t v = 0; v < out.bounds.size(); ++v) out.bounds[v] *= bound_weights_[v];
  for (std::size_t c = 0; c < out.moments.size(); ++c)
    out.moments[c] = system_.couples->mass()[c].cwiseProduct(of.moments[c]);
  return numbers_of(out);
}

// Earlier corrections do not apply to other springs. After a correction of loads only, the residual
// is known: that of the solve plus theirs.
template <int N>
void HeldSolve<N>::correct() {
  ++corrections_;
  const bool may_renew = loads_settled_ || corrections_ > limits_.corrections;
  if (constraints_ && constraints_->renew(vertices_[0].data(), may_renew, x_)) {
    system_.set_weights(constraints_->weights());
    ++report_.constraint_rounds;
    steps_.forget();
    corrections_ = 0;
    return compute_residual(x_, r_);
  }
  if constexpr (N == 3)
    if (constraints_) {
      correction_.bounds = constraints_->correction(vertices_[0].data(), forces_);
      if (system_.hats) correct_loads();
      ++report_.constraint_rounds;
    }
  report_.pad_corrections += system_.hats || system_.couples;
  const Multipliers<N> change = multipliers_of(steps_.change(numbers_of(correction_)), correction_);
  for (std::size_t v = 0; v < change.loads.size(); ++v) multipliers_.loads[v] += change.loads[v];
  for (std::size_t c = 0; c < change.moments.size(); ++c)
    multipliers_.moments[c] += change.moments[c];
  if constexpr (N == 3)
    if (constraints_) constraints_->shift(change.bounds);
  if (!system_.hats || system_.couples || constraints_) return compute_residual(x_, r_);
  LoadsOf<N> shift = zeros<N>(forces_.size());
  system_.hats->add_loads(change.loads, r_);
  add_springs([](std::size_t) { return Vector(Vector::Zero()); }, change.loads, shift, r_);
  for (std::size_t v = 0; v < forces_.size(); ++v) forces_[v] = own_forces_[v] + shift[v];
}

// The last solve can leave a larger residual than the correction; then the next one would change
// nothing. So short solves continue until all constraints are satisfied.
template <int N>
LevelSolve HeldSolve<N>::run(double* x, double* r) {
  x_ = x, r_ = r;
  compute_residual(x_, r_);
  for (bool whole = !system_.hats && !system_.couples && !constraints_;; ++iterations_) {
    solve(whole);
    loads_settled_ = check_loads();
    const bool bounds = check_bounds(), settled = loads_settled_ && bounds;
    const bool loads_end = loads_settled_ || corrections_ >= limits_.corrections;
    const bool ends = (loads_end && bounds) || iterations_ >= most_corrections;
    if (ends && (whole || !limits_.ends_whole || solved_.enough)) return solved_;
    whole = settled || nearly_settled() || iterations_ + 1 >= most_corrections;
    if (!settled)
      correct();
    else if (!system_.hats)
      compute_residual(x_, r_);
    else
      forces_ = own_forces_;
  }
}

template class HeldSolve<1>;
template class HeldSolve<3>;

}  // namespace fairing
