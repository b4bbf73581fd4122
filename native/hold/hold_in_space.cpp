// SPDX-License-Identifier: GPL-3.0-or-later
#include "hold/hold_in_space.h"

#include <algorithm>
#include <cmath>

namespace fairing {
namespace {

// Weights in multipliers of the level below, and the least in stiffnesses of the surface. Measured on
// three meshes within 0.003 to 0.1 of an edge: 2 to 5 take the same iterations, 1 a tenth more. With
// 0.25 and with 1 stiffness ten meshes take as many, but a creature within 0.1 of an edge one and a
// half times; with 0.001 the bishop is thrown far away.
constexpr double weight_by_multiplier = 3, weight_by_stiffness = 0.1;

Vec3 point(const double* x, std::size_t v) { return Eigen::Map<const Vec3>(x + 3 * v); }

}  // namespace

void HoldInSpace::renew(const double* x) {
  if (forces_.empty()) return;
  if (led_away()) weight_outside_ = 1 / weight_by_stiffness;
  first_gap_ = 0;
  aims_.assign(targets_.begin(), targets_.end());
  for (std::size_t v = 0; v < size(); ++v) {
    if (!bound(v)) continue;
    const Vec3 move = move_of(x, v), p = point(x, v) + move;
    const Vec3 force = forces_[v] + base_[v] * (targets_[v] - p + move) + stiffness_[v] * move;
    const double least = std::max(weight_by_stiffness, leaves_ball(x, v) ? weight_outside_ : 0.0);
    weights_[v] = base_[v] + std::max(weight_by_multiplier * forces_[v].norm() / tolerance_[v],
                                      least * stiffness_[v]);
    aims_[v] = weights_[v] > 0 ? Vec3(p + force / weights_[v]) : p;
  }
}

// The energy is convex: with the vertices at x, y within the balls and |z - x| = d, least energies
// are between E + 2 sum P (y - x), for any y, and E + sum 2 (|P| + s d) d.
bool HoldInSpace::settled(double energy, double wanted, const double* x) {
  forces_.resize(size(), Vec3::Zero());
  double gap = 0, farthest = 0;
  for (std::size_t v = 0; v < size(); ++v) {
    if (!bound(v)) continue;
    const Vec3 p = point(x, v), inside = in_ball(p, v), to_target = targets_[v] - inside;
    Vec3& force = forces_[v];
    force = weights_[v] * (aims()[v] - p) - base_[v] * (targets_[v] - p);
    const double pull = force.norm(), outside = (p - inside).norm();
    gap += 2 * (tolerance_[v] * pull - force.dot(to_target)) +
           2 * (pull + stiffness_[v] * outside) * outside;
    farthest = std::max(farthest, (targets_[v] - p).norm() / tolerance_[v]);
  }
  take_gap(gap, energy, farthest);
  if (first_gap_ == 0) first_gap_ = gap_;
  return gap_ <= wanted;
}

std::vector<double> HoldInSpace::correction(const double* x, Loads& forces) const {
  std::vector<double> out(3 * size(), 0.0);
  for (std::size_t v = 0; v < size(); ++v) {
    if (!bound(v) || !(weights_[v] > 0)) continue;
    const Vec3 move = move_of(x, v), pull = stiffness_[v] * move;
    Eigen::Map<Vec3>(out.data() + 3 * v) = move + pull / weights_[v];
    if (!forces.empty()) forces[v] += pull;
  }
  return out;
}

bool HoldInSpace::leaves_ball(const double* x, std::size_t v) const {
  return (point(x, v) - targets_[v]).norm() > tolerance_[v];
}

Vec3 HoldInSpace::move_of(const double* x, std::size_t v) const {
  const Vec3 p = point(x, v);
  const double stiffness = base_[v] + stiffness_[v];
  return (stiffness > 0 ? in_ball(p - forces_[v] / stiffness, v) : p) - p;
}

void HoldInSpace::change(const std::vector<double>& moves) {
  for (std::size_t v = 0; v < size(); ++v) aims_[v] += point(moves.data(), v);
}

Vec3 HoldInSpace::in_ball(const Vec3& p, std::size_t v) const {
  const Vec3 away = p - targets_[v];
  const double length = away.norm();
  return length > tolerance_[v] ? Vec3(targets_[v] + (tolerance_[v] / length) * away) : p;
}

std::vector<double> HoldInSpace::comparable(const Hats* hats) const {
  std::vector<double> out;
  if (!active()) return out;
  double inverse = 0, count = 0;
  const auto under = [&](std::size_t v) { return hats && hats->under(v); };
  for (std::size_t v = 0; v < size(); ++v)
    if (under(v)) {
      inverse += 1 / hats->total(v);
      ++count;
    }
  const double mean = count > 0 ? inverse / count : 1;
  for (std::size_t v = 0; v < size(); ++v) {
    const double both = weights_[v] + stiffness_[v],
                 force = bound(v) && both > 0 ? weights_[v] * stiffness_[v] / both : 0.0;
    out.insert(out.end(), 3, force * force * (under(v) ? 1 / hats->total(v) : mean));
  }
  return out;
}

}  // namespace fairing
