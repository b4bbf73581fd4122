// SPDX-License-Identifier: GPL-3.0-or-later
// Inserts vertices into the sides of faces while flat faces are removed. For mesh/mend/ only.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "mesh/mend/loops.h"

namespace fairing {

// A vertex inside a side of a face, and its position along it.
struct Between {
  double share;
  Index vertex;
  bool operator<(const Between& other) const {
    return share != other.share ? share < other.share : vertex < other.vertex;
  }
};

// A side of faces, and the vertices inside it, in order from `low`.
struct CutSide {
  Index low, high;
  std::vector<Between> between;
};

// The side between vertices a and b, with all of `vertices` strictly inside it: nearer to either
// end than these are to each other.
CutSide cut_side(std::span<const double> coordinates, Index a, Index b,
                 std::span<const Index> vertices);

// The corners inside a side from `here` to `next`, in this order, if that is `side` in either
// direction.
Loop corners_between(const CutSide& side, const MendCorner& here, const MendCorner& next);

// The first cut of each side.
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
