// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/tolerance.h"

#include <algorithm>
#include <cmath>

namespace fairing {
namespace {

// Energies below this share of the largest so far do not count as such: a tolerance as large as the
// mesh leaves none.
constexpr double least_energy = 1e-3;
constexpr double idle = 1e-9;  // of the tolerance: rounding
// Of the first weights and of the least: shares of their unit. The former are as good as fixed; the
// latter keep a closed surface in its place.
constexpr double first_weight = 1e4, least_weight = 1e-10;
// In tolerances: what a step believes of a distance, and within what the last solve may put a
// vertex on its ball.
constexpr double most_away = 10, farthest_away = 2;
// A weight falls to so much of itself in a step; only what is so small beside its neighbours' may
// vanish.
constexpr double few = 0.1;
constexpr double pin_factor = 1e4;  // stiffer than any surface: holds what is left over on the ball

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
  if (!active()) return;
  for (std::size_t v = 0; v < tolerance_.size(); ++v)
    if (bound(v)) weights_[v] = std::max(base_[v], first_weight * unit);
}

double ToleranceConstraint::distance(const double* x, std::size_t v) const {
  return (Eigen::Map<const Vec3>(x + 3 * v) - targets_[v]).norm();
}

void ToleranceConstraint::take_gap(double gap, double energy, double farthest) {
  start_energy_ = std::max(start_energy_, energy);
  const bool pulled = farthest > idle && energy > 0;
  gap_ = pulled ? gap / std::max(energy, least_energy * start_energy_) : 0.0;
}

// The energy is convex, so the force 2 w d at each vertex bounds what the way to its ball's surface
// could still gain; a vertex outside will need more force on the way.
bool ToleranceConstraint::settled(double energy, double wanted, const double* x) {
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
  far_ = !begun_ || !(farthest <= farthest_away);
  return !far_ && gap_ <= wanted;
}

bool ToleranceConstraint::begin(const double* x) {
  if (begun_) return false;
  begun_ = true;
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
void ToleranceConstraint::choose_stiffness() {
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

std::vector<double> ToleranceConstraint::correction(const double* x) {
  choose_stiffness();
  std::vector<double> out(tolerance_.size(), 0.0);
  for (std::size_t v = 0; v < out.size(); ++v) {
    if (!bound(v)) continue;
    const double away = std::min(distance(x, v) / tolerance_[v], most_away);
    out[v] = (weights_[v] + stiffness_[v]) * away - stiffness_[v] - multiplier_[v];
  }
  return out;
}

void ToleranceConstraint::change(std::vector<double>& by) {
  for (std::size_t v = 0; v < by.size(); ++v) {
    if (!bound(v)) continue;
    const double before = multiplier_[v],
                 most = largest_weight_change * (weights_[v] + stiffness_[v]);
    const double least = weights_[v] > few * around_[v] ? few * weights_[v] : -stiffness_[v];
    multiplier_[v] = std::clamp(before + by[v], least, most);
    by[v] = multiplier_[v] - before;
    weights_[v] = std::max({base_[v], multiplier_[v], least_weight * unit_});
  }
}

void ToleranceConstraint::start_level() {
  if (aims_.empty()) return;
  aims_.clear();
  weights_ = unpinned_;
}

void ToleranceConstraint::pin(const double* x) {
  unpinned_ = weights_;
  aims_.assign(targets_.begin(), targets_.end());
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    if (!bound(v) || distance(x, v) <= tolerance_[v]) continue;
    aims_[v] = nearest_allowed(x, v);
    weights_[v] *= pin_factor;
  }
}

// Pulls are multipliers now, of a surface within the tolerance: what each could still gain on the
// way to the best point of its ball.
void ToleranceConstraint::finish(double energy, double* x) {
  double gap = 0, farthest = 0;
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    if (!bound(v)) continue;
    const Eigen::Map<Vec3> p(x + 3 * v);
    const Vec3 pull = weights_[v] * (targets()[v] - p) - base_[v] * (targets_[v] - p);
    if (distance(x, v) > tolerance_[v]) {
      const Vec3 allowed = nearest_allowed(x, v);
      for (std::size_t a = 0; a < 3; ++a) x[3 * v + a] = allowed[Eigen::Index(a)];
    }
    gap += 2 * (tolerance_[v] * pull.norm() - pull.dot(targets_[v] - p));
    farthest = std::max(farthest, distance(x, v) / tolerance_[v]);
  }
  take_gap(gap, energy, farthest);
}

Vec3 ToleranceConstraint::nearest_allowed(const double* x, std::size_t v) const {
  const Vec3& target = targets_[v];
  return target + (tolerance_[v] / distance(x, v)) * (Eigen::Map<const Vec3>(x + 3 * v) - target);
}

int release_control_vertices(ThinPlateSolver& system, const ControlMesh& mesh,
                             std::span<const Vec3> given, double epsilon, Array<double>& x) {
  Unknowns freed = system.shared().unknowns;
  bool any = false;
  for (std::size_t v = 0; v < std::size_t(mesh.input_vertices); ++v) {
    const bool released = !freed.vertex[v] && !mesh.feature_vertex[v] && !mesh.shared(Index(v)) &&
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
