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

// Number of corners for which all pairs are considered: 0.2 s. Longer polygons lose ears first.
constexpr std::size_t longest_whole = 400;

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

// By dynamic programming over the chords between two corners, the shorter ones first.
class Search {
 public:
  explicit Search(const SpacePolygon& polygon)
      : polygon_(polygon),
        size_(polygon.points.size()),
        best_(size_ * size_),
        cost_(size_ * size_) {}

  std::vector<Triangle> run() {
    for (std::size_t i = 0; i + 1 < size_; ++i)
      put(i, i + 1, {{0, 1, 0}, Index(i), polygon_.normals[i]});
    for (std::size_t gap = 2; gap < size_; ++gap)
      for (std::size_t low = 0; low + gap < size_; ++low) {
        stop_if_cancelled();
        const bool whole = gap + 1 == size_;
        if (whole || polygon_.may_join(low, low + gap))
          put(low, low + gap, best_on(low, low + gap));
      }
    return triangles();
  }

 private:
  const Best& at(std::size_t low, std::size_t high) const { return best_[low * size_ + high]; }
  // The costs also by their higher corner, so that best_on() reads both in order.
  void put(std::size_t low, std::size_t high, const Best& best) {
    best_[low * size_ + high] = best;
    cost_[low * size_ + high] = cost_[high * size_ + low] = best.cost;
  }

  Best best_on(std::size_t low, std::size_t high) const {
    Best best;
    const Cost *from = &cost_[low * size_], *to = &cost_[high * size_];
    for (std::size_t middle = low + 1; middle < high; ++middle) {
      const Cost parts = from[middle] + to[middle];
      if (parts.is_less_than(best.cost)) consider({low, middle, high}, parts, best);
    }
    return best;
  }

  // The triangle of three corners, with these `parts` beyond its other two sides.
  void consider(const std::array<std::size_t, 3>& corners, const Cost& parts, Best& best) const {
    const std::vector<Vec3>& p = polygon_.points;
    const auto [i, j, k] = corners;
    Vec3 normal = (p[j] - p[i]).cross(p[k] - p[i]);
    const double length = normal.norm();
    if (length > 0) normal /= length;
    double turns[] = {turn(normal, at(i, j).normal), turn(normal, at(j, k).normal), 1};
    if (i == 0 && k + 1 == size_) turns[2] = turn(normal, polygon_.normals[k]);
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

  std::vector<Triangle> triangles() const {
    std::vector<Triangle> found;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, size_ - 1}};
    while (!open.empty()) {
      const auto [low, high] = open.back();
      open.pop_back();
      if (high == low + 1) continue;
      const Index middle = at(low, high).middle;
      if (middle < 0) return {};
      found.push_back({Index(low), middle, Index(high)});
      open.push_back({std::size_t(middle), high});
      open.push_back({low, std::size_t(middle)});
    }
    return found;
  }

  const SpacePolygon& polygon_;
  std::size_t size_;
  std::vector<Best> best_;
  std::vector<Cost> cost_;
};

}  // namespace

std::vector<Triangle> triangulate(const SpacePolygon& polygon) {
  if (polygon.points.size() < 3) return {};
  if (polygon.points.size() <= longest_whole) return Search(polygon).run();
  Shortened rest = cut_ears(polygon, longest_whole);
  if (rest.corners.size() > longest_whole) return {};
  SpacePolygon left;
  for (const Index corner : rest.corners) left.points.push_back(polygon.points[corner]);
  left.normals = std::move(rest.normals);
  left.may_join = [&](std::size_t low, std::size_t high) {
    return polygon.may_join(std::size_t(rest.corners[low]), std::size_t(rest.corners[high]));
  };
  const std::vector<Triangle> inner = Search(left).run();
  if (inner.empty()) return {};
  std::vector<Triangle> found = std::move(rest.ears);
  for (const Triangle& t : inner)
    found.push_back({rest.corners[t[0]], rest.corners[t[1]], rest.corners[t[2]]});
  return found;
}

}  // namespace fairing
