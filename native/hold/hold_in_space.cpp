// SPDX-License-Identifier: GPL-3.0-or-later
#include "hold/hold_in_space.h"

#include <algorithm>
#include <cmath>

namespace fairing {
namespace {

// Of the first weights and of the least: shares of their unit. The former are as good as fixed; the
// latter keep a closed surface in its place.
constexpr double first_weight = 1e4, least_weight = 1e-10;
// In tolerances: what a step believes of a distance, and within what the last solve may put a
// vertex on its ball.
constexpr double most_away = 10, farthest_away = 2;
// A weight falls to so much of itself in a step; only what is so small beside its neighbours' may
// vanish.
constexpr double largest_weight_drop = 0.1;
// By how much one step changes a weight at most: the surface has yet to follow.
constexpr double largest_weight_change = 10;
// Multipliers that are so many times the surface's stiffness hold a vertex on its ball: so small a
// tolerance is that only directions are to be found. How many vertices may be others.
constexpr double stiffer = 50, most_soft = 0.2;
constexpr double caution = 2;       // of their turns, in stiffnesses: neighbours turn as well
constexpr double pin_factor = 1e4;  // stiffer than any surface: holds what is left over on the ball

}  // namespace

HoldInSpace::HoldInSpace(const ControlMesh& mesh, std::span<const Vec3> targets,
                         const Unknowns& unknowns, std::span<const double> weights, double unit,
                         std::vector<double> tolerances)
    : ControlHold(mesh, targets, unknowns, weights, unit, std::move(tolerances)) {
  for (std::size_t v = 0; active() && v < tolerance_.size(); ++v)
    if (bound(v)) weights_[v] = std::max(base_[v], first_weight * unit);
}

double HoldInSpace::distance(const double* x, std::size_t v) const {
  return (Eigen::Map<const Vec3>(x + 3 * v) - targets_[v]).norm();
}

// The energy is convex, so the force 2 w d at each vertex bounds what the way to its ball's surface
// could still gain; a vertex outside will need more force on the way.
bool HoldInSpace::settled(double energy, double wanted, const double* x) {
  choose_stiffness();
  double gap = 0, farthest = 0;
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    if (!bound(v)) continue;
    const double d = distance(x, v), way = d - tolerance_[v];
    const double force = (weights_[v] - base_[v]) * d + stiffness_[v] * std::max(way, 0.0);
    gap += 2 * force * std::abs(way);
    farthest = std::max(farthest, d / tolerance_[v]);
  }
  take_gap(gap, energy, farthest);
  far_ = multiplier_.empty() || !(farthest <= farthest_away);
  return !far_ && gap_ <= wanted;
}

bool HoldInSpace::begin(const double* x) {
  if (!multiplier_.empty()) return false;
  multiplier_.assign(tolerance_.size(), 0.0);
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    if (!bound(v)) continue;
    multiplier_[v] = weights_[v] * distance(x, v) / tolerance_[v];
    weights_[v] = std::max({base_[v], multiplier_[v], least_weight * unit_});
  }
  return true;
}

// The neighbours' weights resist where the surface hardly does, and the surface where they are
// stiffer than it is.
void HoldInSpace::choose_stiffness() {
  stiffness_.assign(tolerance_.size(), 0.0);
  around_.assign(tolerance_.size(), 0.0);
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    if (!bound(v)) continue;
    double sum = weights_[v], count = 1;
    for (const Spoke& spoke : mesh_.ring(Index(v))) {
      const Edge& edge = mesh_.edges[std::size_t(spoke.edge)];
      const auto other = std::size_t(edge.vertex[spoke.outward ? 1 : 0]);
      if (other >= tolerance_.size() || !bound(other)) continue;
      sum += weights_[other];
      ++count;
    }
    const double around = around_[v] = sum / count, surface = of_surface_[v];
    stiffness_[v] = around * surface / (0.5 * around + surface);
  }
}

std::vector<double> HoldInSpace::correction(const double* x) {
  choose_stiffness();
  std::vector<double> out(tolerance_.size(), 0.0);
  for (std::size_t v = 0; v < out.size(); ++v) {
    if (!bound(v)) continue;
    const double away = std::min(distance(x, v) / tolerance_[v], most_away);
    out[v] = (weights_[v] + stiffness_[v]) * away - stiffness_[v] - multiplier_[v];
  }
  return out;
}

void HoldInSpace::change(std::vector<double>& by) {
  for (std::size_t v = 0; v < by.size(); ++v) {
    if (!bound(v)) continue;
    const double before = multiplier_[v],
                 most = largest_weight_change * (weights_[v] + stiffness_[v]);
    const double least = weights_[v] > largest_weight_drop * around_[v]
                             ? largest_weight_drop * weights_[v]
                             : -stiffness_[v];
    multiplier_[v] = std::clamp(before + by[v], least, most);
    by[v] = multiplier_[v] - before;
    weights_[v] = std::max({base_[v], multiplier_[v], least_weight * unit_});
  }
}

bool HoldInSpace::is_stiff() const {
  if (multiplier_.empty()) return false;
  std::size_t count = 0, soft = 0;
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    if (!bound(v)) continue;
    ++count;
    soft += multiplier_[v] - base_[v] < stiffer * of_surface_[v];
  }
  return double(soft) <= most_soft * double(count);
}

void HoldInSpace::place(const double* x) {
  aims_.assign(targets_.begin(), targets_.end());
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    if (!bound(v)) continue;
    aims_[v] = on_ball(Eigen::Map<const Vec3>(x + 3 * v), v);
    weights_[v] = pin_factor * std::max(weights_[v], of_surface_[v]);
  }
  is_placed_ = true;
}

void HoldInSpace::put_placed(double* x) const {
  for (std::size_t v = 0; v < tolerance_.size(); ++v)
    if (placed(v)) Eigen::Map<Vec3>(x + 3 * v) = aims_[v];
}

void HoldInSpace::take_pulls(const std::vector<Vec3>& forces) {
  pulls_ = forces;
  for (std::size_t v = 0; v < tolerance_.size(); ++v)
    pulls_[v] -= base_[v] * (targets_[v] - aims_[v]);
}

// A step down the energy, and back to the ball.
bool HoldInSpace::turn(double energy, double wanted) {
  double gap = 0;
  for (std::size_t v = 0; v < tolerance_.size(); ++v)
    if (bound(v))
      gap += 2 * (tolerance_[v] * pulls_[v].norm() - pulls_[v].dot(targets_[v] - aims_[v]));
  take_gap(gap, energy, 1);
  if (gap_ <= wanted) return true;
  for (std::size_t v = 0; v < tolerance_.size(); ++v)
    if (bound(v) && of_surface_[v] > 0)
      aims_[v] = on_ball(aims_[v] - pulls_[v] / (caution * of_surface_[v]), v);
  return false;
}

void HoldInSpace::leave_places() {
  aims_.clear();
  is_placed_ = false;
  for (std::size_t v = 0; v < tolerance_.size(); ++v)
    if (bound(v)) weights_[v] = std::max({base_[v], multiplier_[v], least_weight * unit_});
}

void HoldInSpace::pin(const double* x) {
  aims_.assign(targets_.begin(), targets_.end());
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    if (!bound(v) || distance(x, v) <= tolerance_[v]) continue;
    aims_[v] = on_ball(Eigen::Map<const Vec3>(x + 3 * v), v);
    weights_[v] *= pin_factor;
  }
}

// Pulls are multipliers now, of a surface within the tolerance: what each could still gain on the
// way to the best point of its ball.
void HoldInSpace::finish(double energy, double* x) {
  double gap = 0, farthest = 0;
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    if (!bound(v)) continue;
    Eigen::Map<Vec3> p(x + 3 * v);
    const Vec3 pull =
        is_placed_ ? pulls_[v] : Vec3(weights_[v] * (aims()[v] - p) - base_[v] * (targets_[v] - p));
    if (distance(x, v) > tolerance_[v]) p = on_ball(p, v);
    gap += 2 * (tolerance_[v] * pull.norm() - pull.dot(targets_[v] - p));
    farthest = std::max(farthest, distance(x, v) / tolerance_[v]);
  }
  take_gap(gap, energy, farthest);
}

Vec3 HoldInSpace::on_ball(const Vec3& p, std::size_t v) const {
  const Vec3& target = targets_[v];
  const double length = (p - target).norm();
  return length > 0 ? Vec3(target + (tolerance_[v] / length) * (p - target)) : target;
}

std::vector<double> HoldInSpace::comparable(const Pads* pads) const {
  std::vector<double> out;
  if (!active()) return out;
  double inverse = 0, count = 0;
  const auto under = [&](std::size_t v) { return pads && pads->under(v); };
  for (std::size_t v = 0; v < size(); ++v)
    if (under(v)) {
      inverse += 1 / pads->total(v);
      ++count;
    }
  const double mean = count > 0 ? inverse / count : 1;
  for (std::size_t v = 0; v < size(); ++v) {
    const double t = bound(v) ? tolerance_[v] : 0;
    out.push_back(t * t * (under(v) ? 1 / pads->total(v) : mean));
  }
  return out;
}

}  // namespace fairing
