// SPDX-License-Identifier: GPL-3.0-or-later
#include "hold/hold_along_normals.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/rounding.h"

namespace fairing {
namespace {

// Of the tolerance, however much the part across the normal takes; and a vertex that is so near an
// end at the start stands on it, in half intervals.
constexpr double least_reach = 0.1;
// Of one vertex, from end to end, in a step: there is no other limit.
constexpr int most_turns = 4;

}  // namespace

void HoldAlongNormals::look_along(const double* normal, const double* x,
                                  const std::vector<double>& sides, std::vector<double> stiffness) {
  stiffness_ = std::move(stiffness);
  along_.resize(weights_.size());
  reach_.assign(size(), 0.0);
  turns_.assign(size(), 0);
  sides_ = sides;
  sides_.resize(size(), 0.0);
  for (std::size_t v = 0; v < weights_.size(); ++v) {
    const Vec3 offset = Eigen::Map<const Vec3>(x + 3 * v) - targets_[v];
    along_[v] = offset.dot(Eigen::Map<const Vec3>(normal + 3 * v));
    if (v >= size() || !bound(v)) continue;
    const double whole = tolerance_[v] * tolerance_[v];
    reach_[v] = std::sqrt(std::max(whole - offset.squaredNorm() + along_[v] * along_[v],
                                   least_reach * least_reach * whole));
    if (sides.empty() && std::abs(along_[v]) > (1 - least_reach) * reach_[v])
      sides_[v] = along_[v] > 0 ? 1 : -1;
    choose_weight(v);
  }
}

// No spring at all would not keep a closed surface in its place.
void HoldAlongNormals::choose_weight(std::size_t v) {
  const double least = std::max(base_[v], rounding * unit_);
  weights_[v] = sides_[v] != 0 ? std::max(least, stiff * std::max(stiffness_[v], unit_)) : least;
}

bool HoldAlongNormals::settled(double energy, double wanted, const double* h) {
  double gap = 0, farthest = 0;
  for (std::size_t v = 0; v < size(); ++v) {
    if (!bound(v)) continue;
    const double outside = excess(v, h[v]);
    if (sides_[v] != 0) {
      gap += 4 * std::max(0.0, -pressure(v, h[v])) * reach_[v];
    } else if (outside > 0) {
      gap += 2 * stiffness_[v] * outside * outside;
    }
    farthest = std::max(farthest, 1 + outside / reach_[v]);
  }
  take_gap(gap, energy, farthest);
  return gap_ <= wanted;
}

bool HoldAlongNormals::turn(const double* h) {
  bool any = false;
  for (std::size_t v = 0; v < size(); ++v) {
    if (!bound(v)) continue;
    const bool leaves = sides_[v] != 0 && pressure(v, h[v]) < 0 && turns_[v] < most_turns;
    const bool arrives = sides_[v] == 0 && excess(v, h[v]) > 0;
    if (!leaves && !arrives) continue;
    sides_[v] = leaves ? 0 : along_[v] + h[v] > 0 ? 1 : -1;
    ++turns_[v];
    choose_weight(v);
    any = true;
  }
  return any;
}

}  // namespace fairing
