// SPDX-License-Identifier: GPL-3.0-or-later
// Limit positions of vertices whose subdivision rules change from step to step.
#pragma once

#include <vector>

#include "base/types.h"
#include "mesh/sharpness.h"

namespace fairing {

// A vertex's position by its rule at step `steps`, position(rule, steps), blended with the next
// rule in between.
template <class Position>
Vec3 by_rules(const AroundVertex& sharp, int steps, const Position& position) {
  const VertexRule now = rule_of(sharp, steps), next = rule_of(sharp, steps + 1);
  const double share =
      now == next || now == VertexRule::smooth ? 1 : share_of_sharper(sharp, steps);
  Vec3 out = share * position(now, steps);
  if (share < 1) out += (1 - share) * position(next, steps + 1);
  return out;
}

// A vertex, the ends of its spokes, and the far corner of each quad around it. The next ring of
// subdivision depends on these points alone.
struct LimitRing {
  struct Quad {
    Vec3 across;
    std::size_t spoke[2];
  };
  Vec3 vertex;
  std::vector<Vec3> spokes;
  std::vector<Quad> quads;
};

// Whether the sharpness around a vertex changes from step to step, or a crease ends there; then no
// mask of one step gives the limit.
bool takes_many_steps(const AroundVertex& sharp);

// The limit of the vertex, from the ring after the first step. `sharp`: of the spokes, in their
// order.
Vec3 limit_of(LimitRing ring, const AroundVertex& sharp);

}  // namespace fairing
