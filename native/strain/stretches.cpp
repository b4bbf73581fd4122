// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/stretches.h"

#include <cmath>
#include <numbers>

namespace fairing {
namespace {

// A sharp turn is a corner, even if it is not marked. A regular hexagon has six, a heptagon none:
// the limit is the turn of six and a half sides.
constexpr double full_turn = 2 * std::numbers::pi;
bool is_corner(const Vec3& before, const Vec3& after) {
  return before.dot(after) < std::cos(full_turn / 6.5) * before.norm() * after.norm();
}

}  // namespace

std::vector<Stretch> stretches_of(const Chain& chain, std::span<const Vec3> positions) {
  const std::size_t m = chain.vertices.size();
  const auto at = [&](std::size_t v) { return positions[chain.vertices[v % m]]; };
  std::vector<std::size_t> corners;
  for (std::size_t v = 0; v < m; ++v) {
    const bool end = !chain.closed && (v == 0 || v + 1 == m);
    const Vec3 before = at(v) - at(v + m - 1), after = at(v + 1) - at(v);
    if (end || is_corner(before, after)) corners.push_back(v);
  }
  if (corners.empty()) return {{chain.vertices, chain.edges, true}};
  if (chain.closed) corners.push_back(corners.front() + m);
  std::vector<Stretch> out;
  for (std::size_t c = 0; c + 1 < corners.size(); ++c) {
    Stretch& part = out.emplace_back();
    for (std::size_t v = corners[c]; v < corners[c + 1]; ++v) {
      part.vertices.push_back(chain.vertices[v % m]);
      part.edges.push_back(chain.edges[v % m]);
    }
    part.vertices.push_back(chain.vertices[corners[c + 1] % m]);
  }
  return out;
}

}  // namespace fairing
