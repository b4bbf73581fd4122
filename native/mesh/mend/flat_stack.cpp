// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mend/flat_stack.h"

#include <algorithm>

#include "base/points.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Indices = std::vector<Index>;

// All vertices along a side, from end to end; of several at one place only one.
class Line {
 public:
  Line(std::span<const double> coordinates, const CutSide& side, const Indices& vertices)
      : coordinates_(coordinates), kept_{side.low} {
    rank_.emplace_back(side.low, 0);
    for (const Between& one : cut_side(coordinates, side.low, side.high, vertices).between) {
      if (kept_.size() == 1 || inside(kept_.back(), side.high, one.vertex))
        kept_.push_back(one.vertex);
      rank_.emplace_back(one.vertex, kept_.size() - 1);
    }
    rank_.emplace_back(side.high, kept_.size());
    kept_.push_back(side.high);
    std::sort(rank_.begin(), rank_.end());
  }

  CutSide whole() const { return cut(kept_.front(), kept_.back(), 1, kept_.size() - 1); }

  // The side between two of the vertices.
  CutSide side(Index a, Index b) const {
    auto from = rank(a), to = rank(b);
    if (from > to) {
      std::swap(from, to);
      std::swap(a, b);
    }
    if (from == 0) return nearest(a, b, to, false);
    if (to + 1 == kept_.size()) return nearest(a, b, from, true);
    return cut(a, b, from + 1, to);
  }

  // Adds the sides from either end that no face has, but that remain of sides that were cut.
  void add_chains(std::vector<CutSide>& sides) const {
    for (std::size_t k = 1; k + 1 < kept_.size(); ++k) {
      stop_if_cancelled(k);
      sides.push_back(side(kept_.front(), kept_[k]));
      sides.push_back(side(kept_[k], kept_.back()));
    }
  }

 private:
  bool inside(Index a, Index b, Index v) const {
    return !cut_side(coordinates_, a, b, {&v, 1}).between.empty();
  }
  std::size_t rank(Index v) const {
    return std::lower_bound(rank_.begin(), rank_.end(), std::pair(v, std::size_t(0)))->second;
  }
  CutSide cut(Index a, Index b, std::size_t first, std::size_t end) const {
    if (first >= end) return {std::min(a, b), std::max(a, b), {}};
    return cut_side(coordinates_, a, b, std::span(kept_).subspan(first, end - first));
  }
  // The side with the vertex next to the end that is not the line's end.
  CutSide nearest(Index a, Index b, std::size_t at, bool upwards) const {
    const auto is_end = [&](std::size_t k) { return k == 0 || k + 1 == kept_.size(); };
    for (std::size_t k = upwards ? at + 1 : at - 1; !is_end(k); upwards ? ++k : --k)
      if (inside(a, b, kept_[k])) return cut(a, b, k, k + 1);
    return cut(a, b, 0, 0);
  }

  std::span<const double> coordinates_;
  Indices kept_;
  std::vector<std::pair<Index, std::size_t>> rank_;  // of every vertex its place in kept_
};

}  // namespace

CutSide longest_side(std::span<const double> coordinates, std::span<const MendCorner> loop) {
  const auto point = [&](Index v) { return point_at(coordinates, v); };
  CutSide longest{};
  double most = -1;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Index a = loop[i].vertex, b = loop[(i + 1) % loop.size()].vertex;
    const double length = (point(a) - point(b)).norm();
    if (length > most) longest = {std::min(a, b), std::max(a, b), {}};
    most = std::max(most, length);
  }
  return longest;
}

bool spans(std::span<const double> coordinates, std::span<const MendCorner> loop,
           const CutSide& side) {
  bool has_side = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const auto [low, high] = std::minmax(loop[i].vertex, loop[(i + 1) % loop.size()].vertex);
    has_side |= low == side.low && high == side.high;
  }
  return has_side &&
         cut_side(coordinates, side.low, side.high, vertices_of(loop)).between.size() + 2 ==
             loop.size();
}

std::vector<CutSide> cuts_of_stack(std::span<const double> coordinates,
                                   std::span<const Loop> faces) {
  Indices vertices;
  for (const Loop& face : faces)
    for (const MendCorner& corner : face) vertices.push_back(corner.vertex);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const CutSide whole = longest_side(coordinates, faces[0]);
  const Line line(coordinates, whole, vertices);
  std::vector<CutSide> sides{line.whole()};
  line.add_chains(sides);
  for (const Loop& face : faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      CutSide side = line.side(face[i].vertex, face[(i + 1) % face.size()].vertex);
      if (side.low != whole.low || side.high != whole.high) sides.push_back(std::move(side));
    }
  }
  std::erase_if(sides, [](const CutSide& side) { return side.between.empty(); });
  return sides;
}

}  // namespace fairing
