// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/weight_choice.h"

#include <algorithm>
#include <cmath>

#include "base/median.h"
#include "fit/measure.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

constexpr double ratio = 4;       // from one weight to the next
constexpr double softest = 1e-4;  // keeps waves of ten control edges

std::size_t best_of(const std::vector<WeightTrial>& trials) {
  const auto less = [](const auto& a, const auto& b) { return a.error < b.error; };
  return std::size_t(std::min_element(trials.begin(), trials.end(), less) - trials.begin());
}

// The weight of least error, from all weights around the best trial that are worse by no more than
// is known, so that a least one among them says nothing: the error of n points is known within
// 1 / sqrt(2 n) of itself.
double least_of_good(const std::vector<WeightTrial>& trials, std::size_t points, double bias) {
  const double least = trials[best_of(trials)].error;
  std::vector<double> worse;
  for (const auto& trial : trials)
    worse.push_back(least > 0 ? (trial.error / least - 1) * std::sqrt(2 * double(points)) : 0);
  const auto best = std::ptrdiff_t(best_of(trials)), count = std::ptrdiff_t(trials.size());
  const auto end = [&](int way) {
    auto k = best;
    while (k + way >= 0 && k + way < count && worse[k + way] <= 1) k += way;
    double steps = double(k - best);
    if (k + way >= 0 && k + way < count)
      steps += way * (1 - worse[k]) / (worse[k + way] - worse[k]);
    return trials[best].weight * std::pow(ratio, -steps);
  };
  // The error V sqrt(w) + B / w^bias is the same at both ends, which gives B / V.
  const double low = end(1), high = end(-1), rise = std::sqrt(high) - std::sqrt(low),
               fall = std::pow(low, -bias) - std::pow(high, -bias);
  if (!(fall > 0)) return high;
  return std::clamp(std::pow(2 * bias * rise / fall, 1 / (bias + 0.5)), low, high);
}

std::size_t tests_of(std::span<const HeldOut> sets) {
  std::size_t tests = 0;
  for (const HeldOut& held : sets) tests += held.tests.size();
  return tests;
}

}  // namespace

double WeightChoice::choose(Monitor& monitor, bool is_last) {
  if (settings_.weight > 0) {
    fit_.iterate(settings_.weight, 2, true);
    return settings_.weight;
  }
  if (settings_.tolerance > 0) {
    const double weight = by_tolerance(monitor);
    if (weight > 0) return weight;
  }
  is_chosen_by_points_ = true;
  return by_held_out(monitor, is_last);
}

// Variance grows with the root of the weight over the number of points, so the best weight grows with
// a power of that number.
double WeightChoice::more_points(std::size_t points) const {
  if (!is_chosen_by_points_ || trained_points_ == 0) return 1;
  return std::pow(double(points) / double(trained_points_), 1 / (bias_ + 0.5));
}

// Squared distances along the normals of one smooth surface, with outliers limited as in the fit.
// (Along its own normals, a rough surface is nearer to the points than the true one is.)
void WeightChoice::add_errors(const HeldOut& held, WeightTrial& trial) {
  std::vector<double> far;
  for (const HeldOut::Test& test : held.tests)
    far.push_back(std::abs(
        (fit_.scan().point[test.point] - fit_.finder().point_at_foot(test.foot)).dot(test.normal)));
  if (!(cut_ > 0) && !far.empty()) cut_ = 2 * deviation_over_median * median(std::vector(far));
  for (const double d : far)
    trial.squares += d <= cut_ ? d * d : cut_ * (2 * std::min(d, outlier / 2 * cut_) - cut_);
}

// A surface follows the noise that a point that is held out shares with trained ones, and is too
// near to it [Mallows 1973].
void WeightChoice::set_error(WeightTrial& trial, std::size_t tests) const {
  trial.error = tests > 0 ? std::sqrt(trial.squares / double(tests) +
                                      2 * shared_ * fit_.share_followed(trial.weight))
                          : 0;
}

// Trials from `weight` downwards, each the sum of all sets. Leaves the best one's surface of the
// first set.
std::vector<WeightTrial> WeightChoice::search(double weight, std::span<const HeldOut> sets,
                                              const Place& start, Monitor& monitor) {
  std::vector<WeightTrial> trials;
  std::vector<Place> at(sets.size(), start);
  const std::size_t tests = tests_of(sets);
  Place best;
  cut_ = 0;
  for (; trials.empty() || weight > softest; weight /= ratio) {
    monitor.report(Phase::solve, 0.125 + 0.5 * double(trials.size()) / 16);
    WeightTrial trial{weight, 0, 0};
    for (std::size_t k = 0; k < sets.size(); ++k) {
      fit_.train_on(sets[k].trained);
      put(std::move(at[k]));
      fit_.iterate(weight, trials.empty() ? 4 : 2, true);
      add_errors(sets[k], trial);
      at[k] = place();
    }
    set_error(trial, tests);
    trials.push_back(std::move(trial));
    const std::size_t least = best_of(trials);
    if (least + 1 == trials.size()) best = at[0];
    if (trials.back().error > 1.25 * trials[least].error) break;
  }
  fit_.train_on({});
  put(std::move(best));
  return trials;
}

void WeightChoice::use(const std::vector<WeightTrial>& trials, const HeldOut& held) {
  trained_points_ = held.trained_points();
  trials_.clear();
  for (const WeightTrial& trial : trials) trials_.push_back({trial.weight, scale_ * trial.error});
}

// Cells show white noise best. Where noise is correlated over them it seems to be shape, and the
// weight is too large. Discs, which are wider, are then better off with a smaller one, but how small
// they do not tell: a surface with a gap is too calm there. That follows from the noise itself.
double WeightChoice::by_held_out(Monitor& monitor, bool is_last) {
  // Feet and normals are those of a surface with waves of two control edges and more. A surface
  // that follows the noise has tilted normals, and distances along them are too large.
  Place start = place();
  fit_.iterate(1 / (ratio * ratio), 2, false);
  const HeldOut cells = cells_held_out(fit_);
  const std::vector<HeldOut> discs = is_last ? discs_held_out(fit_) : std::vector<HeldOut>();
  const double shared = is_last ? shared_noise(fit_, cells) : 0;
  const Place calm = place();
  const std::vector<WeightTrial> by_cells = search(fit_.stiffest(), {&cells, 1}, start, monitor);
  use(by_cells, cells);
  if (cells.tests.empty()) return by_cells[0].weight;  // a tiny scan: no trial has an error
  const double weight = least_of_good(by_cells, cells.tests.size(), bias_);
  // no noise that matters: what is left is shape
  if (!is_last || spread_of(fit_.feet(), {}).rms <= least_noise * fit_.edge()) return weight;
  Place fitted = place();
  // From a calm surface, on which points hidden by a disc have not acted; from two weights above that
  // of the cells on, so that trials lie on both sides of the least error.
  const std::vector<WeightTrial> by_discs = search(ratio * ratio * weight, discs, calm, monitor);
  put(std::move(fitted));
  const double wider = least_of_good(by_discs, tests_of(discs), bias_);
  if (std::sqrt(ratio) * wider >= weight) return weight;  // known to half a step
  shared_ = shared;
  std::vector<WeightTrial> by_shared = search(fit_.stiffest(), {&cells, 1}, calm, monitor);
  for (std::size_t best = by_shared.size(); best_of(by_shared) < best;) {
    best = best_of(by_shared);
    fit_.iterate(by_shared[best].weight, 2, true);
    shared_ =
        std::min(shared_, shared_noise(fit_, cells));  // a calmer surface's includes some shape
    for (WeightTrial& trial : by_shared) set_error(trial, cells.tests.size());
  }
  use(by_shared, cells);
  return std::min(least_of_good(by_shared, cells.tests.size(), bias_), wider);
}

double WeightChoice::by_tolerance(Monitor& monitor) {
  const auto is_within = [&](double weight) {
    monitor.report(Phase::solve, 0.25);
    fit_.iterate(weight, 2, true);
    return covered_within(fit_.feet()) * scale_ <= settings_.tolerance;
  };
  double high = fit_.stiffest(), low = high;
  if (!is_within(high)) return 0;
  while (low > softest && is_within(low / ratio)) low /= ratio;
  high = low;
  low /= ratio;
  for (int k = 0; k < 5; ++k) {  // bisects to a tenth
    const double middle = std::sqrt(low * high);
    (is_within(middle) ? high : low) = middle;
  }
  fit_.iterate(high, 2, true);
  return high;
}

}  // namespace fairing
