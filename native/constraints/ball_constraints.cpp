// SPDX-License-Identifier: GPL-3.0-or-later
#include "constraints/ball_constraints.h"

#include <algorithm>
#include <cmath>

namespace fairing {
namespace {

// Weights in multipliers of the level below, at least in stiffnesses of the surface. Measured on
// three meshes with tolerances of 0.003 to 0.1 of an edge: 2 to 5 take the same iterations, 1 a
// tenth more. With 0.25 or 1 stiffness ten meshes take as many, but a creature within 0.1 of an
// edge half as many more; with 0.001 the bishop diverges.
constexpr double weight_by_multiplier = 3, weight_by_stiffness = 0.1;

Vec3 point(const double* at, std::size_t v) { return Eigen::Map<const Vec3>(at + 3 * v); }

}  // namespace

void BallConstraints::renew_springs(const double* at) {
  if (forces_.empty()) return;
  if (diverged()) weight_outside_ = 1 / weight_by_stiffness;
  first_gap_ = 0;
  shifted_.assign(targets_.begin(), targets_.end());
  for (std::size_t v = 0; v < size(); ++v) {
    if (!bound(v)) continue;
    const Vec3 move = move_of(at, v), p = point(at, v) + move;
    const Vec3 force = forces_[v] + base_[v] * (targets_[v] - p + move) + stiffness_[v] * move;
    const double least = std::max(weight_by_stiffness, leaves_ball(at, v) ? weight_outside_ : 0.0);
    weights_[v] = base_[v] + std::max(weight_by_multiplier * forces_[v].norm() / tolerance_[v],
                                      least * stiffness_[v]);
    shifted_[v] = weights_[v] > 0 ? Vec3(p + force / weights_[v]) : p;
  }
}

bool BallConstraints::renew(const double* at, bool, double*) {
  if (!shifted_.empty() && !diverged()) return false;
  renew_springs(at);
  return true;
}

// The energy is convex: with the vertices at x, y within the balls and |z - x| = d, the least
// energy is between E + 2 sum P (y - x), for any y, and E + sum 2 (|P| + s d) d.
bool BallConstraints::settled(double energy, double wanted, const double* at) {
  forces_.resize(size(), Vec3::Zero());
  double gap = 0, farthest = 0;
  for (std::size_t v = 0; v < size(); ++v) {
    if (!bound(v)) continue;
    const Vec3 p = point(at, v), inside = in_ball(p, v), to_target = targets_[v] - inside;
    Vec3& force = forces_[v];
    force = weights_[v] * (shifted_targets()[v] - p) - base_[v] * (targets_[v] - p);
    const double pull = force.norm(), outside = (p - inside).norm();
    gap += 2 * (tolerance_[v] * pull - force.dot(to_target)) +
           2 * (pull + stiffness_[v] * outside) * outside;
    farthest = std::max(farthest, (targets_[v] - p).norm() / tolerance_[v]);
  }
  set_gap(gap, energy, farthest);
  if (first_gap_ == 0) first_gap_ = gap_;
  return gap_ <= wanted;
}

std::vector<double> BallConstraints::correction(const double* at, Loads& forces) const {
  std::vector<double> out(3 * size(), 0.0);
  for (std::size_t v = 0; v < size(); ++v) {
    if (!bound(v) || !(weights_[v] > 0)) continue;
    const Vec3 move = move_of(at, v), pull = stiffness_[v] * move;
    Eigen::Map<Vec3>(out.data() + 3 * v) = move + pull / weights_[v];
    if (!forces.empty()) forces[v] += pull;
  }
  return out;
}

bool BallConstraints::leaves_ball(const double* at, std::size_t v) const {
  return (point(at, v) - targets_[v]).norm() > tolerance_[v];
}

Vec3 BallConstraints::move_of(const double* at, std::size_t v) const {
  const Vec3 p = point(at, v);
  const double stiffness = base_[v] + stiffness_[v];
  return (stiffness > 0 ? in_ball(p - forces_[v] / stiffness, v) : p) - p;
}

void BallConstraints::shift(const std::vector<double>& shifts) {
  for (std::size_t v = 0; v < size(); ++v) shifted_[v] += point(shifts.data(), v);
}

std::vector<double> BallConstraints::comparable(const Hats* hats) const {
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
