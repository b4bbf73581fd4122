// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/curve_loads.h"

#include <array>
#include <cmath>

#include "strain/stretches.h"

namespace fairing {
namespace {

constexpr std::size_t in_a_row = 5;  // vertices of a fourth difference

// The weights of a fourth divided difference, times 4! to approximate the derivative.
std::array<double, in_a_row> fourth_derivative(const std::array<double, in_a_row>& at) {
  std::array<double, in_a_row> weight{};
  for (std::size_t k = 0; k < in_a_row; ++k) {
    weight[k] = 24;
    for (std::size_t l = 0; l < in_a_row; ++l)
      if (l != k) weight[k] /= at[k] - at[l];
  }
  return weight;
}

}  // namespace

CurveLoads::CurveLoads(const ControlMesh& mesh, std::span<const Vec3> positions, double exponent) {
  std::vector<Eigen::Triplet<double, Index>> entries;
  std::vector<double> middle;  // of each row, the length that belongs to the middle vertex
  double sum = 0;
  const auto add = [&](const Stretch& stretch) {
    const std::size_t m = stretch.vertices.size();
    if (m < in_a_row) return;
    const auto vertex = [&](std::size_t v) { return stretch.vertices[v % m]; };
    const auto length = [&](std::size_t v) {
      const auto a = std::size_t(vertex(v)), b = std::size_t(vertex(v + 1));
      return std::pow((positions[b] - positions[a]).norm(), exponent);
    };
    for (std::size_t v = stretch.closed ? 0 : 1; v + (stretch.closed ? 0 : 1) < m; ++v) {
      const double share = 0.5 * (length(v + m - 1) + length(v));
      vertices_.push_back(vertex(v));
      roots_.push_back(share);
      sum += share;
    }
    for (std::size_t first = 0; first + (stretch.closed ? 0 : in_a_row - 1) < m; ++first) {
      std::array<double, in_a_row> at{};
      for (std::size_t k = 1; k < in_a_row; ++k) at[k] = at[k - 1] + length(first + k - 1);
      const std::array<double, in_a_row> weight = fourth_derivative(at);
      for (std::size_t k = 0; k < in_a_row; ++k)
        entries.emplace_back(Index(middle.size()), vertex(first + k), weight[k]);
      middles_.push_back(vertex(first + 2));
      middle.push_back(0.5 * (at[3] - at[1]));
    }
  };
  for (const Chain& chain : mesh.features())
    if (!chain.straight)
      for (const Stretch& stretch : stretches_of(chain, positions)) add(stretch);
  const double mean = sum / double(std::max<std::size_t>(vertices_.size(), 1));
  const auto root = [&](double share) { return std::sqrt(share / mean); };
  for (double& share : roots_) share = root(share);
  std::vector<Eigen::Triplet<double, Index>> weighted;
  for (const auto& entry : entries)
    weighted.emplace_back(entry.row(), entry.col(), root(middle[entry.row()]) * entry.value());
  differences_.resize(Eigen::Index(middle.size()), mesh.vertex_count());
  differences_.setFromTriplets(weighted.begin(), weighted.end());
}

Columns columns_of(std::span<const Vec3> points) {
  Columns out(Eigen::Index(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v) out.row(Eigen::Index(v)) = points[v].transpose();
  return out;
}

}  // namespace fairing
