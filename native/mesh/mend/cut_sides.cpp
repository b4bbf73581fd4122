// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mend/cut_sides.h"

#include <algorithm>

#include "base/points.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// Position of a corner along the input's side between two corners; -1: not on it.
double place_on(const CornerOrigin& origin, Index from, Index to) {
  if (origin.share == 0) return origin.from == from ? 0 : origin.from == to ? 1 : -1;
  if (origin.from == from && origin.beside == to) return origin.share;
  return origin.from == to && origin.beside == from ? 1 - origin.share : -1;
}

// A point at this share of the way from corner a to the next corner b.
CornerOrigin origin_between(const CornerOrigin& a, const CornerOrigin& b, double share) {
  const bool cut = a.share != 0 || b.share == 0;
  const Index from = a.share == 0 && b.share != 0 ? b.from : a.from;
  const Index to = a.share != 0 ? a.beside : cut ? b.from : b.beside;
  const double begin = place_on(a, from, to), end = place_on(b, from, to);
  if (begin < 0 || end < 0) return share < 0.5 ? a : b;
  return {from, to, begin + share * (end - begin)};
}

}  // namespace

CutSide cut_side(std::span<const double> coordinates, Index a, Index b,
                 std::span<const Index> vertices) {
  const auto point = [&](Index v) { return point_at(coordinates, v); };
  CutSide side{std::min(a, b), std::max(a, b), {}};
  const Vec3 begin = point(side.low), end = point(side.high), along = end - begin;
  for (const Index v : vertices) {
    if (v == a || v == b) continue;
    const double share = along.dot(point(v) - begin) / along.squaredNorm();
    const double farther = std::max((point(v) - begin).norm(), (point(v) - end).norm());
    if (share > 0 && share < 1 && farther < along.norm()) side.between.push_back({share, v});
  }
  std::sort(side.between.begin(), side.between.end());
  return side;
}

Loop corners_between(const CutSide& side, const MendCorner& here, const MendCorner& next) {
  Loop corners;
  const bool ahead = here.vertex == side.low;
  const std::size_t count = side.between.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Between& one = side.between[ahead ? k : count - 1 - k];
    const double share = ahead ? one.share : 1 - one.share;
    corners.push_back({one.vertex, origin_between(here.origin, next.origin, share)});
  }
  return corners;
}

void CutSides::add(CutSide side) {
  const std::pair ends(side.low, side.high);
  cut_.try_emplace(ends, std::move(side));
}

// This ends, since every piece is shorter than the whole (Dissolver::cut_side).
Loop CutSides::expanded(std::span<const MendCorner> loop) const {
  Loop longer;
  std::vector<std::pair<MendCorner, MendCorner>> sides;  // not yet visited, the next one last
  std::size_t steps = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    sides.push_back({loop[i], loop[(i + 1) % loop.size()]});
    while (!sides.empty()) {
      stop_if_cancelled(++steps);
      const auto [here, next] = sides.back();
      sides.pop_back();
      const auto cut = cut_.find(std::minmax(here.vertex, next.vertex));
      if (cut == cut_.end()) {
        longer.push_back(here);
        continue;
      }
      const Loop between = corners_between(cut->second, here, next);
      for (std::size_t k = between.size(); k > 0; --k)
        sides.push_back({between[k - 1], k < between.size() ? between[k] : next});
      sides.push_back({here, between.front()});
    }
  }
  return longer;
}

std::vector<CutEdge> CutSides::edges() const {
  std::vector<CutEdge> edges;
  for (const auto& [ends, side] : cut_) {
    CutEdge& edge = edges.emplace_back(CutEdge{ends.first, ends.second, {}});
    for (const Between& one : side.between) edge.between.push_back(one.vertex);
  }
  return edges;
}

}  // namespace fairing
