// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/limit_ring.h"

#include <cmath>

namespace fairing {
namespace {

// The ring after step number `steps`.
void subdivide(const AroundVertex& sharp, int steps, LimitRing& ring) {
  const auto n = double(ring.spokes.size());
  std::vector<Vec3> beside(ring.spokes.size(), Vec3::Zero());
  Vec3 sum = Vec3::Zero();
  for (const Vec3& end : ring.spokes) sum += end;
  for (LimitRing::Quad& quad : ring.quads) {
    const auto [a, b] = quad.spoke;
    quad.across = (ring.vertex + ring.spokes[a] + ring.spokes[b] + quad.across) / 4;
    beside[a] += quad.across;
    beside[b] += quad.across;
    sum += quad.across;
  }
  const Vec3 vertex = by_rules(sharp, steps, [&](VertexRule rule, int at) -> Vec3 {
    if (rule == VertexRule::smooth) return (n - 2) / n * ring.vertex + sum / (n * n);
    if (rule == VertexRule::corner) return ring.vertex;
    Vec3 on_crease = 0.75 * ring.vertex;
    for (std::size_t i = 0; i < ring.spokes.size(); ++i)
      if (after(sharp.spokes[i], at) > 0) on_crease += 0.125 * ring.spokes[i];
    return on_crease;
  });
  for (std::size_t i = 0; i < ring.spokes.size(); ++i) {
    const double share = std::min(1.0, after(sharp.spokes[i], steps));
    const Vec3 ends = ring.vertex + ring.spokes[i];
    ring.spokes[i] =
        share < 1 ? Vec3(share / 2 * ends + (1 - share) / 4 * (ends + beside[i])) : Vec3(ends / 2);
  }
  ring.vertex = vertex;
}

}  // namespace

bool takes_many_steps(const AroundVertex& sharp) {
  const auto is_semi_sharp = [](double s) { return s > 0 && std::isfinite(s); };
  if (is_semi_sharp(sharp.vertex) || std::ranges::any_of(sharp.spokes, is_semi_sharp)) return true;
  return !sharp.spokes.empty() && rule_of(sharp, 0) == VertexRule::smooth;  // a dart
}

Vec3 limit_of(LimitRing ring, const AroundVertex& sharp) {
  // The rest of a ring shrinks by a third a step at least, the second eigenvalue for high valences:
  // two steps give a binary digit.
  const int steps = int(always_sharp) + 2 * std::numeric_limits<double>::digits;
  for (int s = 1; s <= steps; ++s) subdivide(sharp, s, ring);
  return ring.vertex;
}

}  // namespace fairing
