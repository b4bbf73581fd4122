// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fill/triangulate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/roundoff.h"
#include "mesh/fill/ears.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// Number of corners for which all pairs are considered: 0.2 s. Longer polygons lose ears first;
// those that remain longer are processed through a window of this number of corners, which doubles
// its stride whenever it is full: 5,000 corners in 7 s.
constexpr std::size_t longest_whole = 400, window_size = 128;

// The cost of triangles, in order of priority.
struct Cost {
  double folding = std::numeric_limits<double>::infinity();  // sum of the cosines of folds
  double cosine = -2;                                        // of the largest angle
  double area = std::numeric_limits<double>::infinity();

  bool is_less_than(const Cost& other) const {
    if (folding != other.folding) return folding < other.folding;
    return cosine > other.cosine || (cosine == other.cosine && area < other.area);
  }

  // The cost of two parts, without the edge between them.
  Cost operator+(const Cost& other) const {
    return {folding + other.folding, std::min(cosine, other.cosine), area + other.area};
  }
};

struct Best {
  Cost cost;
  Index middle = -1;  // third corner of the triangle on this chord; -1: none
  Vec3 normal = Vec3::Zero();
};

// The chords in use and where they are stored. Corner i is at place i of a line, the last one where
// all strides meet.
class Chords {
 public:
  explicit Chords(std::size_t corners) : corners_(corners) {
    window_ = corners <= longest_whole ? corners : window_size;
    while (window_ << top_ < corners - 1) ++top_;
    const std::size_t stride = std::size_t(1) << top_;
    end_ = (corners - 1 + stride - 1) / stride * stride;
    for (std::size_t level = 0; level <= top_; ++level) {
      begin_.push_back(kept_.size());
      kept_.resize(kept_.size() + ((end_ >> level) + 1) * window_);
    }
    by_start_.resize((end_ + 1) * window_);
    by_end_.resize((end_ + 1) * window_);
  }

  std::size_t top() const { return top_; }
  std::size_t window() const { return window_; }
  std::size_t place(std::size_t corner) const { return corner + 1 == corners_ ? end_ : corner; }
  bool is_corner(std::size_t place) const { return place + 1 < corners_ || place == end_; }
  std::size_t corner(std::size_t place) const { return place == end_ ? corners_ - 1 : place; }
  std::size_t last_place() const { return end_; }

  // Null if the chord between two places is not used.
  Best* find(std::size_t low, std::size_t high) {
    std::size_t level = 0;
    while (window_ << level < high - low) ++level;
    const std::size_t mask = (std::size_t(1) << level) - 1;
    if ((low | high) & mask) return nullptr;
    return &kept_[begin_[level] + (low >> level) * window_ + ((high - low) >> level) - 1];
  }

  // Copies of chords up to the window's length, in the order in which look_at() reads them: those
  // from `low` by length, and those to `high`.
  void note(std::size_t low, std::size_t high, const Cost& cost) {
    if (high - low > window_) return;
    by_start_[low * window_ + high - low - 1] = by_end_[high * window_ + high - low - 1] = cost;
  }
  const Cost* from(std::size_t low) const { return &by_start_[low * window_]; }
  const Cost* to(std::size_t high) const { return &by_end_[high * window_]; }

 private:
  std::size_t corners_, window_ = 0, top_ = 0, end_ = 0;
  std::vector<std::size_t> begin_;
  std::vector<Best> kept_;
  std::vector<Cost> by_start_, by_end_;
};

class Search {
 public:
  explicit Search(const SpacePolygon& polygon)
      : polygon_(polygon), chords_(polygon.points.size()) {}

  std::vector<Triangle> run() {
    const std::size_t size = polygon_.points.size();
    for (std::size_t i = 0; i + 1 < size; ++i) {
      const std::size_t end = i + 2 == size ? chords_.last_place() : i + 1;
      Best* side = chords_.find(i, end);
      if (!side) continue;
      *side = {{0, 1, 0}, Index(i), polygon_.normals[i]};
      chords_.note(i, end, side->cost);
    }
    for (std::size_t level = 0; level <= chords_.top(); ++level)
      for (std::size_t gap = level ? chords_.window() / 2 + 1 : 2; gap <= chords_.window(); ++gap)
        look_at_all(level, gap << level);
    return triangles();
  }

 private:
  void look_at_all(std::size_t level, std::size_t gap) {
    const std::size_t stride = std::size_t(1) << level;
    for (std::size_t low = 0; low + gap <= chords_.last_place(); low += stride) {
      stop_if_cancelled();
      const std::size_t high = low + gap;
      if (chords_.is_corner(low) && chords_.is_corner(high)) look_at(low, high, level);
    }
  }

  void look_at(std::size_t low, std::size_t high, std::size_t level) {
    const std::size_t first = chords_.corner(low), last = chords_.corner(high);
    const bool whole = first == 0 && last + 1 == polygon_.points.size();
    if (last == first + 1) return;  // the last side, if it is long
    Best& best = *chords_.find(low, high);
    if (!whole && !polygon_.may_join(first, last)) return;
    if (level == 0) {
      const Cost *from = chords_.from(low), *to = chords_.to(high);
      for (std::size_t middle = low + 1; middle < high; ++middle) {
        const Cost parts = from[middle - low - 1] + to[high - middle - 1];
        if (parts.is_less_than(best.cost)) consider(low, middle, high, parts, best);
      }
      chords_.note(low, high, best.cost);
      return;
    }
    // the longer of the other two sides spans at least half of this one
    const std::size_t stride = std::size_t(1) << (level - 1);
    for (std::size_t middle = low + stride; middle < high; middle += stride) {
      if (!chords_.is_corner(middle)) continue;
      const Best *left = chords_.find(low, middle), *right = chords_.find(middle, high);
      if (!left || !right) continue;
      const Cost parts = left->cost + right->cost;
      if (parts.is_less_than(best.cost)) consider(low, middle, high, parts, best);
    }
  }

  // The triangle of three places, with these `parts` beyond its other two sides.
  void consider(std::size_t low, std::size_t middle, std::size_t high, const Cost& parts,
                Best& best) {
    const std::vector<Vec3>& p = polygon_.points;
    const std::size_t i = chords_.corner(low), j = chords_.corner(middle), k = chords_.corner(high);
    Vec3 normal = (p[j] - p[i]).cross(p[k] - p[i]);
    const double length = normal.norm();
    if (length > 0) normal /= length;
    double turns[] = {turn(normal, chords_.find(low, middle)->normal),
                      turn(normal, chords_.find(middle, high)->normal), 1};
    if (i == 0 && k + 1 == p.size()) turns[2] = turn(normal, polygon_.normals[k]);
    Cost cost = parts;
    for (const double t : turns) {
      cost.folding += std::max(0.0, -t);
      cost.cosine = std::min(cost.cosine, t);
    }
    cost.area += length / 2;
    if (cost.is_less_than(best.cost)) best = {cost, Index(j), normal};
  }

  // The cosine between two normals, in steps, so that rounding does not decide in flat holes. A
  // triangle without area counts as the worst.
  static double turn(const Vec3& normal, const Vec3& other) {
    if (other.isZero()) return 1;
    return normal.isZero() ? -1 : std::round(normal.dot(other) / single_roundoff) * single_roundoff;
  }

  std::vector<Triangle> triangles() {
    std::vector<Triangle> found;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, chords_.last_place()}};
    while (!open.empty()) {
      const auto [low, high] = open.back();
      open.pop_back();
      const std::size_t first = chords_.corner(low), last = chords_.corner(high);
      if (last == first + 1) continue;
      const Best* best = chords_.find(low, high);
      if (!best || best->middle < 0) return {};
      const std::size_t middle = chords_.place(std::size_t(best->middle));
      found.push_back({Index(first), best->middle, Index(last)});
      open.push_back({middle, high});
      open.push_back({low, middle});
    }
    return found;
  }

  const SpacePolygon& polygon_;
  Chords chords_;
};

}  // namespace

std::vector<Triangle> triangulate(const SpacePolygon& polygon) {
  if (polygon.points.size() < 3) return {};
  if (polygon.points.size() <= longest_whole) return Search(polygon).run();
  Shortened rest = cut_ears(polygon, longest_whole);
  SpacePolygon left;
  for (const Index corner : rest.corners) left.points.push_back(polygon.points[corner]);
  left.normals = std::move(rest.normals);
  left.may_join = [&](std::size_t low, std::size_t high) {
    return polygon.may_join(std::size_t(rest.corners[low]), std::size_t(rest.corners[high]));
  };
  const std::vector<Triangle> inner = Search(left).run();
  if (inner.empty()) return Search(polygon).run();
  std::vector<Triangle> found = std::move(rest.ears);
  for (const Triangle& t : inner)
    found.push_back({rest.corners[t[0]], rest.corners[t[1]], rest.corners[t[2]]});
  return found;
}

}  // namespace fairing
