// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/hold.h"

#include <algorithm>
#include <cmath>

#include "curvature/steps.h"

namespace fairing {
namespace {

// A weight changes by this power of |p - c| / tolerance: neighbours share the load, so that weights
// answer less than one to one.
constexpr double response = 1.5;
// Of the unit: lets a vertex go as good as freely, and keeps it among those that are held.
constexpr double least_weight = 1e-8;

}  // namespace

double curvature_weight_unit(const ControlMesh& mesh) {
  double sum = 0;
  for (const Edge& edge : mesh.edges)
    sum +=
        (mesh.positions[std::size_t(edge.vertex[1])] - mesh.positions[std::size_t(edge.vertex[0])])
            .squaredNorm();
  return sum > 0 ? double(mesh.edges.size()) / sum : 1.0;
}

ControlHold::ControlHold(const ControlMesh& mesh, std::span<const Vec3> targets,
                         const Unknowns& unknowns, std::span<const double> weights,
                         std::vector<double> tolerances)
    : targets_(targets), unknowns_(unknowns), tolerance_(std::move(tolerances)) {
  if (!unknowns.any_vertex) return;
  const double unit = curvature_weight_unit(mesh);
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    tolerance_[v] *= tolerance_aim;
    adapts_ |= bound(v);
  }
  base_.assign(std::size_t(mesh.vertex_count()), 0.0);
  for (std::size_t v = 0; v < weights.size(); ++v)
    if (unknowns.vertex[v]) base_[v] = unit * weights[v];
  weights_ = base_;
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    if (!bound(v)) continue;
    base_[v] = std::max(base_[v], least_weight * unit);
    weights_[v] = std::max(base_[v], unit);
  }
}

bool ControlHold::bound(std::size_t v) const {
  return v < tolerance_.size() && unknowns_.vertex[v] && std::isfinite(tolerance_[v]);
}

Vec3 ControlHold::away(const Array<double>& x, std::size_t v) const {
  return Vec3(x[3 * v], x[3 * v + 1], x[3 * v + 2]) - targets_[v];
}

void ControlHold::adapt(const Array<double>& x) {
  for (std::size_t v = 0; v < weights_.size(); ++v) {
    if (!bound(v)) continue;
    const double ratio = std::pow(away(x, v).norm() / tolerance_[v], response);
    weights_[v] = std::max(base_[v], weights_[v] * std::clamp(ratio, 1 / largest_weight_change,
                                                              largest_weight_change));
  }
}

bool ControlHold::holds(const Array<double>& x) const {
  for (std::size_t v = 0; v < weights_.size(); ++v)
    if (bound(v) && away(x, v).norm() > tolerance_slack * tolerance_[v]) return false;
  return true;
}

void ControlHold::enforce(Array<double>& x) const {
  for (std::size_t v = 0; v < weights_.size(); ++v) {
    if (!bound(v)) continue;
    const Vec3 offset = away(x, v);
    const double length = offset.norm();
    if (!(length > tolerance_[v])) continue;
    const Vec3 p = targets_[v] + (tolerance_[v] / length) * offset;
    for (std::size_t a = 0; a < 3; ++a) x[3 * v + a] = p[Eigen::Index(a)];
  }
}

Unknowns ControlHold::without_held() const {
  Unknowns out = unknowns_;
  out.any_vertex = false;
  for (std::size_t v = 0; v < out.vertex.size(); ++v) {
    if (v < weights_.size() && weights_[v] > 0) out.vertex[v] = 0;
    out.any_vertex |= bool(out.vertex[v]);
  }
  return out;
}

namespace {

// A second round starts from the first one's vertices, and takes most of what is left.
constexpr int release_rounds = 2;
// The weight of released vertices, in those that balance the bending of a control edge: less lets
// the step carry them far beyond epsilon, more holds them short of it.
constexpr double release_pull = 0.1;

void follow(SurfaceIterate& iterate, TotalCurvatureSteps& steps, CurvatureLevelReport& report) {
  iterate.linearize();
  steps.polish(short_patience, iterate.current.energy, report);
}

// Interpolated vertices inside the region that lie on no curve, and on one sheet only.
Unknowns with_interpolated(const ControlMesh& mesh, const Unknowns& fixed) {
  Unknowns freed = fixed;
  for (Index v = 0; v < mesh.input_vertices; ++v) {
    const bool stays = fixed.vertex[std::size_t(v)] || mesh.feature_vertex[std::size_t(v)] ||
                       mesh.ring(v).empty() || mesh.vertex_part(v) != RegionPart::inside ||
                       mesh.shared(v);
    if (!stays) freed.vertex[std::size_t(v)] = freed.any_vertex = true;
  }
  return freed;
}

}  // namespace

void fix_held(SurfaceIterate& iterate, const ControlHold& hold, TotalCurvatureSteps& steps,
              CurvatureLevelReport& report) {
  CurvatureShared& shared = iterate.system.shared();
  shared.unknowns = hold.without_held();
  shared.weights.clear();
  if (!hold.adapts()) return;
  hold.enforce(iterate.current.points);
  follow(iterate, steps, report);
}

void release_by_epsilon(SurfaceIterate& iterate, double epsilon, TotalCurvatureSteps& steps,
                        CurvatureLevelReport& report) {
  GaussNewtonSystem& system = iterate.system;
  CurvatureShared& shared = system.shared();
  const ControlMesh& mesh = system.mesh();
  const Unknowns fixed = shared.unknowns, freed = with_interpolated(mesh, fixed);
  const std::vector<Vec3> targets = mesh.positions;
  const auto is_released = [&](std::size_t v) { return freed.vertex[v] && !fixed.vertex[v]; };
  const double weight = release_pull * curvature_weight_unit(mesh);
  for (int round = 0; round < release_rounds; ++round) {
    shared.unknowns = freed;
    shared.targets = targets;
    shared.weights.assign(targets.size(), 0.0);
    for (std::size_t v = 0; v < targets.size(); ++v)
      if (is_released(v)) shared.weights[v] = weight;
    iterate.linearize();
    system.linearize_below(iterate.level, iterate.current.points);
    system.set_damping(iterate.level, {});
    StepReport unreported;
    NormalLoads no_loads;
    system.solve(iterate.level, iterate.current.linearization, true, iterate.step, no_loads,
                 unreported);
    for (std::size_t v = 0; v < targets.size(); ++v) {
      if (!is_released(v)) continue;
      const Eigen::Map<const Vec3> normal(iterate.current.linearization.normal.data() + 3 * v);
      Eigen::Map<Vec3> p(iterate.current.points.data() + 3 * v);
      Vec3 offset = p + iterate.step[v] * normal - targets[v];
      const double length = offset.norm();
      if (length > tolerance_aim * epsilon) offset *= tolerance_aim * epsilon / length;
      p = targets[v] + offset;
    }
    system.symmetrizer().points(iterate.grid(), iterate.current.points);
    shared.unknowns = fixed;
    shared.weights.clear();
    follow(iterate, steps, report);
  }
}

}  // namespace fairing
