// SPDX-License-Identifier: GPL-3.0-or-later
// Sides of faces that get vertices in between, while flat faces go. For mesh/mend/ only.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "mesh/mend/loops.h"

namespace fairing {

// A vertex inside a side of a face, and how far along.
struct Between {
  double share;
  Index vertex;
  bool operator<(const Between& other) const {
    return share != other.share ? share < other.share : vertex < other.vertex;
  }
};

// A side of faces, and what lies inside it, in order from `low`.
struct CutSide {
  Index low, high;
  std::vector<Between> between;
};

// The side between vertices a and b, with all of `vertices` that lie strictly inside it: nearer to
// either end than these are to each other.
CutSide cut_side(std::span<const double> coordinates, Index a, Index b,
                 std::span<const Index> vertices);

// The corners inside a side from `here` to `next`, in this order, if that is `side` whichever way
// round.
Loop corners_between(const CutSide& side, const MendCorner& here, const MendCorner& next);

// Every side's first cut.
class CutSides {
 public:
  void add(CutSide side);
  // A loop with all vertices inside its sides, and inside the pieces of these.
  Loop expanded(std::span<const MendCorner> loop) const;
  std::vector<CutEdge> edges() const;

 private:
  std::map<std::pair<Index, Index>, CutSide> cut_;
};

}  // namespace fairing
