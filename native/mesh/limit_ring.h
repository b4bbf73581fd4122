// SPDX-License-Identifier: GPL-3.0-or-later
// Limit positions of vertices where the rules of subdivision change from step to step.
#pragma once

#include <vector>

#include "base/types.h"
#include "mesh/sharpness.h"

namespace fairing {

// A vertex's position by its rule at step number `steps`, position(rule, steps), mixed with the next
// one where it is between two.
template <class Position>
Vec3 by_rules(const AroundVertex& sharp, int steps, const Position& position) {
  const VertexRule now = rule_of(sharp, steps), next = rule_of(sharp, steps + 1);
  const double share =
      now == next || now == VertexRule::smooth ? 1 : share_of_sharper(sharp, steps);
  Vec3 out = share * position(now, steps);
  if (share < 1) out += (1 - share) * position(next, steps + 1);
  return out;
}

// A vertex, the ends of its spokes, and in each quad around it the corner across. Subdivision makes the
// next such ring from these points alone.
struct LimitRing {
  struct Quad {
    Vec3 across;
    std::size_t spoke[2];
  };
  Vec3 vertex;
  std::vector<Vec3> spokes;
  std::vector<Quad> quads;
};

// Whether what is sharp about a vertex changes from step to step, or ends there: then no mask of one
// step leads to the limit.
bool takes_many_steps(const AroundVertex& sharp);

// The limit of the vertex, from the ring after the first step. `sharp`: of the spokes, in their order.
Vec3 limit_of(LimitRing ring, const AroundVertex& sharp);

}  // namespace fairing
