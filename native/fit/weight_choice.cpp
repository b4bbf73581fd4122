// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/weight_choice.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/median.h"
#include "fit/measure.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

constexpr double ratio = 4;       // from one weight to the next
constexpr double softest = 1e-4;  // keeps waves of ten control edges

// One in ten, by a well mixed number [splitmix64].
bool is_held_out(std::uint64_t blob) {
  blob += 0x9e3779b97f4a7c15u;
  blob = (blob ^ (blob >> 30)) * 0xbf58476d1ce4e5b9u;
  blob = (blob ^ (blob >> 27)) * 0x94d049bb133111ebu;
  return (blob ^ (blob >> 31)) % 10 == 0;
}

}  // namespace

double WeightChoice::choose(Monitor& monitor) {
  if (settings_.weight > 0) {
    fit_.iterate(settings_.weight, 2, true);
    return settings_.weight;
  }
  if (settings_.tolerance > 0) {
    const double weight = by_tolerance(monitor);
    if (weight > 0) return weight;
  }
  is_chosen_by_points_ = true;
  return by_held_out(monitor);
}

// For a plate under noise the best weight by area grows with the 2/5 power of the number of points:
// the bias falls with the square of the weight, the variance grows with its root over that number.
double WeightChoice::more_points(std::size_t points) const {
  if (!is_chosen_by_points_) return 1;
  const auto trained = std::count(trained_.begin(), trained_.end(), 1);
  return trained > 0 ? std::pow(double(points) / double(trained), 2.0 / 5) : 1;
}

// Holds out cells, since the noise of scanners is correlated between adjacent points. (Wider
// groups, of half a control edge, favour weights three times too large.)
void WeightChoice::hold_out() {
  const GridLevel& grid = fit_.cells().grid();
  const auto faces = double(grid.mesh().faces.size());
  int level = fit_.level();
  while (level > 1 && double(fit_.feet().size()) < points_a_blob * faces * std::pow(4.0, level))
    --level;
  const GridLevel coarse(grid.mesh(), level);
  Workers workers(1);
  const Cells blobs(coarse, workers);
  trained_.assign(fit_.feet().size(), 1);
  held_.clear();
  for (std::size_t s = 0; s < trained_.size(); ++s) {
    const Foot& foot = fit_.feet()[s];
    if (foot.cell < 0) continue;
    const FacePlace place = fit_.cells().place(foot.cell, foot.shares);
    if (!is_held_out(std::uint64_t(blobs.cell_at(place, fit_.level()).cell))) continue;
    trained_[s] = 0;
    if (foot.is_used()) held_.push_back({s, foot, fit_.finder().normal_at(foot)});
  }
}

// Root mean square distance along the normals of one smooth surface, with outliers limited as in
// the fit. (Along its own normals, a rough surface is nearer to the points than the true one is.)
double WeightChoice::held_out_error() {
  std::vector<double> far;
  for (const HeldOut& held : held_)
    far.push_back(std::abs(
        (fit_.scan().point[held.point] - fit_.finder().point_at_foot(held.foot)).dot(held.normal)));
  if (far.empty()) return 0;
  if (trials_.empty()) cut_ = 2 * deviation_over_median * median(std::vector(far));
  double sum = 0;
  for (const double d : far)
    sum += d <= cut_ ? d * d : cut_ * (2 * std::min(d, outlier / 2 * cut_) - cut_);
  return std::sqrt(sum / double(far.size()));
}

// The middle, by logarithms, of all weights that are as good as the `best` trial's: the error of n
// points is known within 1 / sqrt(2 n) of itself, so a least one among them says nothing. In trials
// after the best.
double WeightChoice::middle_of_good(std::size_t best) const {
  if (held_.empty()) return 0;  // a tiny scan: no trial has an error
  const double good = trials_[best][1] * (1 + 1 / std::sqrt(2 * double(held_.size())));
  const auto reach = [&](int way) {
    auto k = std::ptrdiff_t(best);
    const auto count = std::ptrdiff_t(trials_.size());
    while (k + way >= 0 && k + way < count && trials_[k + way][1] <= good) k += way;
    double end = double(k) - double(best);
    if (k + way >= 0 && k + way < count) {
      const double here = trials_[k][1], beyond = trials_[k + way][1];
      end += way * (good - here) / (beyond - here);
    }
    return end;
  };
  return (reach(-1) + reach(1)) / 2;
}

double WeightChoice::by_held_out(Monitor& monitor) {
  // Feet and normals are those of a surface with waves of two control edges and more. A surface
  // that follows the noise has tilted normals, and distances along them are too large.
  trials_.clear();
  Array<double> start = fit_.surface();
  Array<Foot> feet = fit_.feet();
  fit_.iterate(1 / (ratio * ratio), 2, false);
  hold_out();
  fit_.set_surface(std::move(start), std::move(feet));
  fit_.train_on(trained_);
  Array<double> best_surface;
  Array<Foot> best_feet;
  std::size_t best = 0;
  for (double weight = fit_.stiffest(); weight > softest; weight /= ratio) {
    monitor.report(Phase::solve, 0.125 + 0.5 * double(trials_.size()) / 16);
    fit_.iterate(weight, trials_.empty() ? 4 : 2, true);
    trials_.push_back({weight, scale_ * held_out_error()});
    const double error = trials_.back()[1];
    if (trials_.size() == 1 || error < trials_[best][1]) {
      best = trials_.size() - 1;
      best_surface = fit_.surface();
      best_feet = fit_.feet();
    }
    if (error > 1.25 * trials_[best][1]) break;
  }
  const double weight = trials_[best][0] * std::pow(ratio, -middle_of_good(best));
  fit_.train_on({});
  fit_.set_surface(std::move(best_surface), std::move(best_feet));
  return weight;
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
