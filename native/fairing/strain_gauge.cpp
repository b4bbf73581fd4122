// SPDX-License-Identifier: GPL-3.0-or-later
#include "fairing/strain_gauge.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace fairing {

// Each face's share is its area vector; a quad's is that of its diagonals.
Vec3 normal_of(const ControlMesh& mesh, Index v) {
  Vec3 sum = Vec3::Zero();
  const auto at = [&](Index u) -> const Vec3& { return mesh.positions[std::size_t(u)]; };
  for (const Spoke& spoke : mesh.ring(v)) {
    if (spoke.face < 0) continue;
    const Face& f = mesh.faces[std::size_t(spoke.face)];
    const Vec3 &a = at(f.vertex[0]), &b = at(f.vertex[1]), &c = at(f.vertex[2]);
    sum += f.quad() ? (c - a).cross(at(f.vertex[3]) - b) : (b - a).cross(c - a);
  }
  return sum.stableNormalized();
}

void Strain::restore(const std::vector<Index>& origin) {
  for (std::size_t v = 0; v < std::min(origin.size(), ways.size()); ++v) {
    const auto lead = std::size_t(origin[v]);
    ways[v] = ways[lead];
    lengths[v] = lengths[lead];
    on_curve[v] = on_curve[lead];
  }
}

StrainGauge::StrainGauge(const FairingProblem& problem, std::vector<double> own)
    : problem_(problem),
      own_(std::move(own)),
      curves_(problem.mesh, problem.basis.working, problem.exponent) {
  for (const Index v : curves_.middles())
    if (problem.mesh.vertex_part(v) == RegionPart::inside) curve_vertices_.push_back(v);
  const LoadMatrix all = LoadMatrix(curves_.differences().transpose()) * curves_.differences();
  std::vector<Eigen::Triplet<double, Index>> entries;
  std::vector<Index> number(std::size_t(problem.mesh.vertex_count()), -1);
  for (std::size_t i = 0; i < curve_vertices_.size(); ++i)
    number[std::size_t(curve_vertices_[i])] = Index(i);
  for (std::size_t i = 0; i < curve_vertices_.size(); ++i)
    for (LoadMatrix::InnerIterator entry(all, curve_vertices_[i]); entry; ++entry)
      if (const Index column = number[std::size_t(entry.col())]; column >= 0)
        entries.emplace_back(Index(i), column, entry.value());
  const auto count = Eigen::Index(curve_vertices_.size());
  pulls_.resize(count, count);
  pulls_.setFromTriplets(entries.begin(), entries.end());
}

Columns StrainGauge::pulls_of(std::span<const Vec3> positions) const {
  const Columns all =
      curves_.differences().transpose() * (curves_.differences() * columns_of(positions)).eval();
  Columns out(Eigen::Index(curve_vertices_.size()), 3);
  for (std::size_t i = 0; i < curve_vertices_.size(); ++i)
    out.row(Eigen::Index(i)) = all.row(curve_vertices_[i]);
  return out;
}

Strain StrainGauge::read(const Loads& loads, std::span<const Vec3> positions) const {
  const auto n = std::size_t(problem_.mesh.input_vertices);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Strain out{std::vector<Vec3>(n, Vec3::Constant(none)), std::vector<double>(n, none),
             std::vector<std::uint8_t>(n, 0)};
  const double unit = problem_.frame.scale;
  for (std::size_t v = 0; v < std::min(n, own_.size()); ++v) {
    if (!(own_[v] > 0)) continue;
    out.ways[v] = -unit / own_[v] * loads[v];
    out.lengths[v] = out.ways[v].dot(normal_of(problem_.mesh, Index(v)));
  }
  const Columns pulls = pulls_of(positions);
  for (std::size_t i = 0; i < curve_vertices_.size(); ++i) {
    const auto v = std::size_t(curve_vertices_[i]);
    const double own = pulls_.coeff(Index(i), Index(i));
    if (!(own > 0)) continue;
    out.on_curve[v] = 1;
    out.ways[v] = -unit / own * pulls.row(Eigen::Index(i)).transpose();
    out.lengths[v] =
        std::copysign(out.ways[v].norm(), out.ways[v].dot(normal_of(problem_.mesh, Index(v))));
  }
  return out;
}

}  // namespace fairing
