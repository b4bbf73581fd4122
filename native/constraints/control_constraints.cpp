// SPDX-License-Identifier: GPL-3.0-or-later
#include "constraints/control_constraints.h"

#include <algorithm>
#include <cmath>

#include "base/roundoff.h"

namespace fairing {
namespace {

// Least share of the first energy in relative gaps; a tolerance as large as the mesh leaves none.
constexpr double least_energy = 1e-3;

}  // namespace

double weight_unit(const ControlMesh& mesh, const std::vector<FlatFace>& flat) {
  double sum = 0;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const double l = edge_length(mesh, flat, Index(e));
    sum += l * l;
  }
  return sum > 0 ? double(mesh.edges.size()) / sum : 1.0;
}

double weight_unit(const ControlMesh& mesh) {
  double sum = 0;
  for (const Edge& edge : mesh.edges)
    sum += (mesh.positions[edge.vertex[1]] - mesh.positions[edge.vertex[0]]).squaredNorm();
  return sum > 0 ? double(mesh.edges.size()) / sum : 1.0;
}

ControlConstraints::ControlConstraints(const ControlMesh& mesh, std::span<const Vec3> targets,
                                       const Unknowns& unknowns, std::span<const double> weights,
                                       double unit, std::vector<double> tolerances)
    : mesh_(mesh),
      targets_(targets),
      unknowns_(unknowns),
      unit_(unit),
      tolerance_(std::move(tolerances)) {
  if (!unknowns.any_vertex) return;
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    tolerance_[v] *= 1 - 1 / stiff;  // springs give way
    active_ |= bound(v);
  }
  base_.assign(std::size_t(mesh.vertex_count()), 0.0);
  for (std::size_t v = 0; v < weights.size(); ++v)
    if (unknowns.vertex[v]) base_[v] = unit * weights[v];
  weights_ = base_;
}

VertexWeights ControlConstraints::start_weights() const {
  VertexWeights out = weights_;
  for (std::size_t v = 0; active_ && v < size(); ++v)
    if (bound(v)) out[v] = std::max(base_[v], stiff * unit_);
  return out;
}

void ControlConstraints::set_gap(double gap, double energy, double farthest) {
  if (start_energy_ == 0) start_energy_ = energy;
  const bool pulled = farthest > roundoff && energy > 0;
  gap_ = pulled ? gap / std::max(energy, least_energy * start_energy_) : 0.0;
}

void ControlConstraints::enforce(double* x) const {
  for (std::size_t v = 0; v < tolerance_.size(); ++v) {
    Eigen::Map<Vec3> p(x + 3 * v);
    if (bound(v)) p = in_ball(p, v);
  }
}

Vec3 ControlConstraints::in_ball(const Vec3& p, std::size_t v) const {
  const Vec3 away = p - targets_[v];
  const double length = away.norm();
  return length > tolerance_[v] ? Vec3(targets_[v] + (tolerance_[v] / length) * away) : p;
}

Unknowns ControlConstraints::without_held() const {
  Unknowns out = unknowns_;
  out.any_vertex = false;
  for (std::size_t v = 0; v < out.vertex.size(); ++v) {
    if (v < weights_.size() && weights_[v] > 0) out.vertex[v] = 0;
    out.any_vertex |= bool(out.vertex[v]);
  }
  return out;
}

}  // namespace fairing
