// SPDX-License-Identifier: GPL-3.0-or-later
#include "constraints/interval_constraints.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/roundoff.h"

namespace fairing {
namespace {

// Least half interval, in tolerances, however large the component across the normal is; also the
// distance, in half intervals, within which a vertex starts at an end.
constexpr double least_reach = 0.1;
// Of one vertex between ends in a step, which has no other limit.
constexpr int most_changes = 4;

}  // namespace

void IntervalConstraints::linearize_about(const double* normal, const double* x,
                                          const std::vector<double>& ends,
                                          std::vector<double> stiffness) {
  stiffness_ = std::move(stiffness);
  along_.resize(weights_.size());
  reach_.assign(size(), 0.0);
  changes_.assign(size(), 0);
  ends_ = ends;
  ends_.resize(size(), 0.0);
  for (std::size_t v = 0; v < weights_.size(); ++v) {
    const Vec3 offset = Eigen::Map<const Vec3>(x + 3 * v) - targets_[v];
    along_[v] = offset.dot(Eigen::Map<const Vec3>(normal + 3 * v));
    if (v >= size() || !bound(v)) continue;
    const double whole = tolerance_[v] * tolerance_[v];
    reach_[v] = std::sqrt(std::max(whole - offset.squaredNorm() + along_[v] * along_[v],
                                   least_reach * least_reach * whole));
    if (ends.empty() && std::abs(along_[v]) > (1 - least_reach) * reach_[v])
      ends_[v] = along_[v] > 0 ? 1 : -1;
    choose_weight(v);
  }
}

// Without any spring a closed surface could move away.
void IntervalConstraints::choose_weight(std::size_t v) {
  const double least = std::max(base_[v], roundoff * unit_);
  weights_[v] = on_end(v) ? std::max(least, stiff * std::max(stiffness_[v], unit_)) : least;
}

double IntervalConstraints::end_for(std::size_t v, double h) const {
  if (on_end(v)) return pressure(v, h) < 0 && changes_[v] < most_changes ? 0.0 : ends_[v];
  if (!(excess(v, h) > 0)) return 0.0;
  return along_[v] + h > 0 ? 1.0 : -1.0;
}

bool IntervalConstraints::settled(double energy, double wanted, const double* h) {
  double gap = 0, farthest = 0;
  bool any_changes = false;
  for (std::size_t v = 0; v < size(); ++v) {
    if (!bound(v)) continue;
    const double outside = excess(v, h[v]);
    if (on_end(v))
      gap += 4 * std::max(0.0, -pressure(v, h[v])) * reach_[v];
    else if (outside > 0)
      gap += 2 * stiffness_[v] * outside * outside;
    farthest = std::max(farthest, 1 + outside / reach_[v]);
    any_changes |= end_for(v, h[v]) != ends_[v];
  }
  set_gap(gap, energy, farthest);
  return gap_ <= wanted || !any_changes;
}

bool IntervalConstraints::renew(const double* h, bool loads_settled, double* x) {
  bool any = false;
  for (std::size_t v = 0; v < size() && loads_settled; ++v) {
    if (!bound(v)) continue;
    const double end = end_for(v, h[v]);
    if (end == ends_[v]) continue;
    ends_[v] = end;
    ++changes_[v];
    choose_weight(v);
    any = true;
  }
  if (any) put_on_ends(x);
  return any;
}

void IntervalConstraints::put_on_ends(double* x) const {
  for (std::size_t v = 0; v < size(); ++v)
    if (on_end(v)) x[v] = target(v);
}

}  // namespace fairing
