// SPDX-License-Identifier: GPL-3.0-or-later
#include "fair/control_hold.h"

#include <algorithm>
#include <cmath>

namespace fairing {
namespace {

constexpr double aim = 0.9999;  // of the tolerance: rounding must not carry a vertex over it
constexpr double slack = 1.02;
constexpr double largest_change = 10, response = 1.5;
constexpr double least_weight = 1e-8;  // of the unit

}  // namespace

double curvature_weight_unit(const ControlMesh& mesh) {
  double sum = 0;
  for (const Edge& edge : mesh.edges)
    sum += (mesh.positions[std::size_t(edge.vertex[1])] - mesh.positions[std::size_t(edge.vertex[0])])
               .squaredNorm();
  return sum > 0 ? double(mesh.edges.size()) / sum : 1.0;
}

ControlHold::ControlHold(const ControlMesh& mesh, std::span<const Vec3> places, const Unknowns& unknowns,
                         const FairOptions& options, double tolerance)
    : places_(places), unknowns_(unknowns) {
  if (!unknowns.any_vertex || options.interpolation == Interpolation::exact) return;
  const double unit = curvature_weight_unit(mesh);
  tolerance_ = aim * tolerance;
  base_.assign(std::size_t(mesh.vertex_count()), 0.0);
  for (std::size_t v = 0; v < options.weights.size(); ++v)
    if (unknowns.vertex[v]) base_[v] = unit * options.weights[v];
  weights_ = base_;
  if (!adapts()) return;
  for (std::size_t v = 0; v < std::size_t(mesh.input_vertices); ++v)
    if (unknowns.vertex[v]) weights_[v] = base_[v] = std::max(base_[v], least_weight * unit);
  for (std::size_t v = 0; v < std::size_t(mesh.input_vertices); ++v)
    if (unknowns.vertex[v]) weights_[v] = std::max(base_[v], unit);
}

Vec3 ControlHold::away(const Array<double>& x, std::size_t v) const {
  return Vec3(x[3 * v], x[3 * v + 1], x[3 * v + 2]) - places_[v];
}

void ControlHold::adapt(const Array<double>& x) {
  for (std::size_t v = 0; v < weights_.size(); ++v) {
    if (!(base_[v] > 0)) continue;
    const double ratio = std::pow(away(x, v).norm() / tolerance_, response);
    weights_[v] = std::max(base_[v], weights_[v] * std::clamp(ratio, 1 / largest_change, largest_change));
  }
}

bool ControlHold::holds(const Array<double>& x) const {
  for (std::size_t v = 0; v < weights_.size(); ++v)
    if (base_[v] > 0 && away(x, v).norm() > slack * tolerance_) return false;
  return true;
}

void ControlHold::enforce(Array<double>& x) const {
  for (std::size_t v = 0; v < weights_.size(); ++v) {
    const Vec3 offset = away(x, v);
    const double length = offset.norm();
    if (!(base_[v] > 0) || !(length > tolerance_)) continue;
    const Vec3 p = places_[v] + (tolerance_ / length) * offset;
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

}  // namespace fairing
