// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/tolerance.h"

#include <algorithm>
#include <cmath>

namespace fairing {
namespace {

constexpr double idle = 1e-9;  // of the tolerance: rounding

// The duality gap, relative to the energy, at which the fixed point ends. Energies below this share
// of the largest so far do not count as such: a tolerance as large as the mesh leaves none.
constexpr double gap_wanted = 5e-4, least_energy = 1e-3;

// Rounds on the finest level; those before, which cost little, take three times as many. Each
// solves to round_tolerance, as far as the weights deserve.
constexpr int most_rounds = 12, coarse_factor = 3;
constexpr double round_tolerance = 1e-4;

// A step of the fixed point multiplies a weight by (distance / tolerance)^power, within a factor of
// largest_weight_change; the power rises while the error keeps its sign, for neighbours share the
// load, and falls, to one, where it changes.
constexpr double largest_power = 6, power_rise = 1.4, power_fall = 2;
// Weights never vanish, so that products can bring them back; share of their unit.
constexpr double least_weight = 1e-10;

constexpr double pin = 1e4;  // stiffer than any surface: holds what is left over on the ball

// Of the release by epsilon. Neighbouring control vertices share fits on grids coarser than
// first_undamped_level: they step half as far there.
constexpr int release_rounds = 3, first_undamped_level = 2;
constexpr double release_damping = 0.5, release_tolerance = 1e-8;

Vec3 point(const Array<double>& x, std::size_t v) { return {x[3 * v], x[3 * v + 1], x[3 * v + 2]}; }

void put(Array<double>& x, std::size_t v, const Vec3& p) {
  for (std::size_t a = 0; a < 3; ++a) x[3 * v + a] = p[Eigen::Index(a)];
}

}  // namespace

double weight_unit(const ControlMesh& mesh, const std::vector<FlatFace>& flat) {
  double sum = 0;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const double l = edge_length(mesh, flat, Index(e));
    sum += l * l;
  }
  return sum > 0 ? double(mesh.edges.size()) / sum : 1.0;
}

ToleranceConstraint::ToleranceConstraint(const ControlMesh& mesh, std::span<const Vec3> targets,
                                         const Unknowns& unknowns, std::span<const double> weights,
                                         double unit, std::vector<double> tolerances)
    : mesh_(mesh),
      targets_(targets),
      unknowns_(unknowns),
      unit_(unit),
      tolerance_(std::move(tolerances)) {
  if (!unknowns.any_vertex) return;
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    tolerance_[v] *= tolerance_aim;
    active_ |= bound(v);
  }
  base_.assign(std::size_t(mesh.vertex_count()), 0.0);
  for (std::size_t v = 0; v < weights.size(); ++v)
    if (unknowns.vertex[v]) base_[v] = unit * weights[v];
  weights_ = base_;
  power_.assign(base_.size(), 1.0);
  was_outside_.assign(base_.size(), 0);
  if (!active()) return;
  for (std::size_t v = 0; v < tolerance_.size(); ++v)
    if (bound(v)) weights_[v] = std::max(base_[v], unit);
}

double ToleranceConstraint::distance(const Array<double>& x, std::size_t v) const {
  return (point(x, v) - targets_[v]).norm();
}

// The energy is convex, so the force 2 w d at each vertex bounds what the way to its ball's surface
// could still gain.
bool ToleranceConstraint::settled(double energy, const Array<double>& x) {
  double gap = 0;
  bool outside = false, pulled = false;
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    if (!bound(v)) continue;
    const double d = distance(x, v);
    gap += 2 * (weights_[v] - base_[v]) * d * std::abs(tolerance_[v] - d);
    outside |= !(d <= tolerance_slack * tolerance_[v]);
    pulled |= !(d <= idle * tolerance_[v]);
  }
  start_energy_ = std::max(start_energy_, energy);
  gap_ = energy > 0 ? gap / std::max(energy, least_energy * start_energy_) : 0.0;
  if (!pulled) gap_ = 0;
  return !outside && gap_ <= gap_wanted;
}

void ToleranceConstraint::adapt(const Array<double>& x) {
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    if (!bound(v)) continue;
    const double ratio = distance(x, v) / tolerance_[v];
    const bool outside = ratio > 1;
    power_[v] = outside == bool(was_outside_[v]) ? std::min(largest_power, power_[v] * power_rise)
                                                 : std::max(1.0, power_[v] / power_fall);
    was_outside_[v] = outside;
    const double factor =
        std::clamp(std::pow(ratio, power_[v]), 1 / largest_weight_change, largest_weight_change);
    weights_[v] = std::max({base_[v], factor * weights_[v], least_weight * unit_});
  }
}

void ToleranceConstraint::settle(ThinPlateSolver& system, int level, Array<double>& x) {
  if (!active()) return;
  const int rounds = level == system.top() ? most_rounds : coarse_factor * most_rounds;
  for (int round = 0; round < rounds; ++round) {
    if (settled(system.energy(level, x.data()), x)) return;
    adapt(x);
    system.set_weights(weights_, level);
    system.solve_again(level, targets_, x, round_tolerance);
    ++rounds_;
  }
}

LevelReport ToleranceConstraint::finish(ThinPlateSolver& system, double relative_residual,
                                        Array<double>& x) {
  std::vector<Vec3> targets(targets_.begin(), targets_.end());
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    if (!bound(v) || distance(x, v) <= tolerance_[v]) continue;
    targets[v] = nearest_allowed(x, v);
    weights_[v] *= pin;
  }
  system.set_weights(weights_, system.top());
  const LevelReport report = system.solve_again(system.top(), targets, x, relative_residual);
  for (std::size_t v = 0; v < tolerance_.size(); ++v)
    if (bound(v) && distance(x, v) > tolerance_[v]) put(x, v, nearest_allowed(x, v));
  ++rounds_;
  return report;
}

Vec3 ToleranceConstraint::nearest_allowed(const Array<double>& x, std::size_t v) const {
  const Vec3& target = targets_[v];
  return target + (tolerance_[v] / distance(x, v)) * (point(x, v) - target);
}

int release_control_vertices(ThinPlateSolver& system, const ControlMesh& mesh,
                             std::span<const Vec3> given, double epsilon, Array<double>& x) {
  Unknowns freed = system.shared().unknowns;
  bool any = false;
  for (std::size_t v = 0; v < std::size_t(mesh.input_vertices); ++v) {
    const bool released = !freed.vertex[v] && !mesh.feature_vertex[v] &&
                          !mesh.ring(Index(v)).empty() &&
                          mesh.vertex_part(Index(v)) == RegionPart::inside;
    freed.vertex[v] = released;
    any |= released;
  }
  if (!any) return 0;
  freed.any_vertex = true;
  ThinPlateShared& shared = system.shared();
  const GridLevel& grid = system.grid(system.top());
  const VertexWeights none;
  const Array<float> diagonal =
      thin_plate_diagonal(grid, shared.stencils, freed, none, shared.workers, shared.double_slots);
  const double damping = grid.level() >= first_undamped_level ? 1.0 : release_damping;
  std::vector<Vec3> targets(given.begin(), given.end());
  Array<double> gradient(x.size());
  for (int round = 0; round < release_rounds; ++round) {
    apply_thin_plate(grid, shared.double_rows, freed, none, shared.workers, shared.double_slots,
                     x.data(), gradient.data());
    for (std::size_t v = 0; v < std::size_t(mesh.input_vertices); ++v) {
      if (!freed.vertex[v] || !(diagonal[v] > 0)) continue;
      // The energy is isotropic in one vertex, so the nearest point of the ball is the best one in
      // it.
      Vec3 offset = targets[v] - damping / double(diagonal[v]) * point(gradient, v) - given[v];
      const double length = offset.norm();
      if (length > tolerance_aim * epsilon) offset *= tolerance_aim * epsilon / length;
      targets[v] = given[v] + offset;
      put(x, v, targets[v]);
    }
    system.solve_again(system.top(), targets, x, release_tolerance);
  }
  return release_rounds;
}

}  // namespace fairing
