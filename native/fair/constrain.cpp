// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/constrain.h"

#include <algorithm>
#include <cmath>

namespace fairing {
namespace {

constexpr double aim = 0.9999;  // of the tolerance: rounding must not carry a vertex over it
constexpr double slack =
    1.02;  // a fixed point within this is as good as there: finish() holds the rest on the ball
constexpr double idle = 1e-9;  // of the tolerance: rounding
constexpr double gap_wanted = 5e-4;
constexpr int most_rounds =
    12;                      // on the finest level; those before, which cost little, take three times as many
constexpr double pin = 1e4;  // stiffer than any surface: holds what is left over on the ball
constexpr double round_tolerance = 1e-4;
constexpr double largest_change = 10;
constexpr double largest_power = 6;

constexpr int release_rounds = 3;

Vec3 point(const Array<double>& x, std::size_t v) { return {x[3 * v], x[3 * v + 1], x[3 * v + 2]}; }

void put(Array<double>& x, std::size_t v, const Vec3& p) {
  for (std::size_t a = 0; a < 3; ++a) x[3 * v + a] = p[Eigen::Index(a)];
}

}  // namespace

bool control_vertex_moves(const FairOptions& options, Index v) {
  if (options.interpolation == Interpolation::exact) return false;
  if (options.weights.empty()) return options.tolerance > 0;
  return std::isfinite(options.weights[std::size_t(v)]);
}

double weight_unit(const ControlMesh& mesh, const std::vector<FlatFace>& flat) {
  double sum = 0;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const double l = edge_length(mesh, flat, Index(e));
    sum += l * l;
  }
  return sum > 0 ? double(mesh.edges.size()) / sum : 1.0;
}

ToleranceConstraint::ToleranceConstraint(const ControlMesh& mesh, std::span<const Vec3> places,
                                         const Unknowns& unknowns, const FairOptions& options, double unit,
                                         double tolerance)
    : mesh_(mesh), places_(places), unknowns_(unknowns), tolerance_(tolerance * aim), unit_(unit) {
  if (!unknowns.any_vertex || options.interpolation == Interpolation::exact) {
    tolerance_ = 0;
    return;
  }
  base_.assign(std::size_t(mesh.vertex_count()), 0.0);
  for (std::size_t v = 0; v < options.weights.size(); ++v)
    if (unknowns.vertex[v]) base_[v] = unit * options.weights[v];
  weights_ = base_;
  power_.assign(base_.size(), 1.0);
  was_outside_.assign(base_.size(), 0);
  if (!active()) return;
  for (std::size_t v = 0; v < std::size_t(mesh.input_vertices); ++v)
    if (unknowns.vertex[v]) weights_[v] = std::max(base_[v], unit);
}

double ToleranceConstraint::distance(const Array<double>& x, std::size_t v) const {
  return (point(x, v) - places_[v]).norm();
}

// The energy is convex, so the force 2 w d at each vertex bounds what the way to its ball's surface could still gain.
bool ToleranceConstraint::settled(double energy, const Array<double>& x) {
  double gap = 0, farthest = 0;
  for (std::size_t v = 0; v < std::size_t(mesh_.input_vertices); ++v) {
    if (!unknowns_.vertex[v]) continue;
    const double d = distance(x, v);
    gap += 2 * (weights_[v] - base_[v]) * d * std::abs(tolerance_ - d);
    farthest = std::max(farthest, d);
  }
  start_energy_ = std::max(start_energy_, energy);
  // A tolerance as large as the mesh leaves no energy to compare with.
  gap_ = energy > 0 ? gap / std::max(energy, 1e-3 * start_energy_) : 0.0;
  if (farthest <= idle * tolerance_) gap_ = 0;  // nothing pulls
  return farthest <= slack * tolerance_ && gap_ <= gap_wanted;
}

void ToleranceConstraint::adapt(const Array<double>& x) {
  for (std::size_t v = 0; v < std::size_t(mesh_.input_vertices); ++v) {
    if (!unknowns_.vertex[v]) continue;
    const double ratio = distance(x, v) / tolerance_;
    // Neighbours share the load, so weights answer less than one to one: press on where the error keeps its sign.
    const bool outside = ratio > 1;
    power_[v] = outside == bool(was_outside_[v]) ? std::min(largest_power, power_[v] * 1.4)
                                                 : std::max(1.0, power_[v] / 2);
    was_outside_[v] = outside;
    const double factor = std::clamp(std::pow(ratio, power_[v]), 1 / largest_change, largest_change);
    weights_[v] = std::max({base_[v], factor * weights_[v], 1e-10 * unit_});
  }
}

void ToleranceConstraint::settle(SurfaceSystem& system, int level, Array<double>& x) {
  if (!active()) return;
  const int rounds = level == system.top() ? most_rounds : 3 * most_rounds;
  for (int round = 0; round < rounds; ++round) {
    if (settled(system.energy(level, x.data()), x)) return;
    adapt(x);
    system.set_weights(weights_, level);
    system.solve_again(level, places_, x, round_tolerance);
    ++rounds_;
  }
}

LevelReport ToleranceConstraint::finish(SurfaceSystem& system, double relative_residual, Array<double>& x) {
  std::vector<Vec3> targets(places_.begin(), places_.end());
  for (std::size_t v = 0; v < std::size_t(mesh_.input_vertices); ++v) {
    if (!unknowns_.vertex[v] || distance(x, v) <= tolerance_) continue;
    targets[v] = nearest_allowed(x, v);
    weights_[v] *= pin;
  }
  system.set_weights(weights_, system.top());
  const LevelReport report = system.solve_again(system.top(), targets, x, relative_residual);
  for (std::size_t v = 0; v < std::size_t(mesh_.input_vertices); ++v)
    if (unknowns_.vertex[v] && distance(x, v) > tolerance_) put(x, v, nearest_allowed(x, v));
  ++rounds_;
  return report;
}

Vec3 ToleranceConstraint::nearest_allowed(const Array<double>& x, std::size_t v) const {
  const Vec3& place = places_[v];
  return place + (tolerance_ / distance(x, v)) * (point(x, v) - place);
}

int release_control_vertices(SurfaceSystem& system, const ControlMesh& mesh, std::span<const Vec3> places,
                             double epsilon, Array<double>& x) {
  Unknowns freed = system.shared().unknowns;
  bool any = false;
  for (std::size_t v = 0; v < std::size_t(mesh.input_vertices); ++v) {
    const bool released = !freed.vertex[v] && !mesh.feature_vertex[v] && !mesh.ring(Index(v)).empty() &&
                          mesh.vertex_place(Index(v)) == Place::inside;
    freed.vertex[v] = released;
    any |= released;
  }
  if (!any) return 0;
  freed.any_vertex = true;
  ThinPlateShared& shared = system.shared();
  const Lattice& lattice = system.lattice(system.top());
  const VertexWeights none;
  const Array<float> diagonal =
      thin_plate_diagonal(lattice, shared.fine_rows, freed, none, shared.workers, shared.fine_exchange);
  // Neighbouring control vertices share fits on the coarsest lattices: step half as far there.
  const double damping = lattice.level() >= 2 ? 1.0 : 0.5;
  std::vector<Vec3> targets(places.begin(), places.end());
  Array<double> gradient(x.size());
  for (int round = 0; round < release_rounds; ++round) {
    apply_thin_plate(lattice, shared.fine_rows, freed, none, shared.workers, shared.fine_exchange, x.data(),
                     gradient.data());
    for (std::size_t v = 0; v < std::size_t(mesh.input_vertices); ++v) {
      if (!freed.vertex[v] || !(diagonal[v] > 0)) continue;
      // The energy is isotropic in one vertex, so the nearest point of the ball is the best one in it.
      Vec3 offset = targets[v] - damping / double(diagonal[v]) * point(gradient, v) - places[v];
      const double length = offset.norm();
      if (length > aim * epsilon) offset *= aim * epsilon / length;
      targets[v] = places[v] + offset;
      put(x, v, targets[v]);
    }
    system.solve_again(system.top(), targets, x, 1e-8);
  }
  return release_rounds;
}

}  // namespace fairing
