// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fill/triangulate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "base/points.h"
#include "base/roundoff.h"
#include "mesh/sharp_turn.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// The rest of a polygon.
struct Shortened {
  std::vector<Triangle> ears;  // corners, ascending
  std::vector<Index> corners;  // the remaining ones, in their order
  std::vector<Vec3> normals;   // of the face behind the side from each of these to the next
};

class Ears {
 public:
  explicit Ears(const SpacePolygon& polygon)
      : polygon_(polygon), normals_(polygon.normals), count_(polygon.points.size()) {
    for (std::size_t i = 0; i < count_; ++i) {
      before_.push_back((i + count_ - 1) % count_);
      after_.push_back((i + 1) % count_);
    }
    changes_.assign(count_, 0);
    for (std::size_t i = 0; i < count_; ++i) look_at(i);
  }

  Shortened cut(std::size_t enough) {
    Shortened found;
    while (count_ > enough) {
      if (open_.empty() && !admit_sharp_ears()) break;
      stop_if_cancelled(count_);
      const Candidate best = open_.top();
      open_.pop();
      if (best.change != changes_[best.corner]) continue;
      const std::size_t i = best.corner, a = before_[i], b = after_[i];
      Triangle ear{Index(a), Index(i), Index(b)};
      std::sort(ear.begin(), ear.end());  // equivalent to a rotation
      found.ears.push_back(ear);
      normals_[a] = normal(i);
      after_[a] = b, before_[b] = a;
      ++changes_[i];
      last_cut_ = i;
      --count_;
      look_at(a), look_at(b);
    }
    const std::size_t first = after_[last_cut_];
    std::size_t i = first;
    do {
      found.corners.push_back(Index(i));
      i = after_[i];
    } while (i != first);
    std::rotate(found.corners.begin(), std::min_element(found.corners.begin(), found.corners.end()),
                found.corners.end());
    for (const Index corner : found.corners) found.normals.push_back(normals_[corner]);
    return found;
  }

 private:
  struct Candidate {
    double cosine;  // of the angle at the corner
    std::size_t corner;
    int change;  // number of changes of the corner's neighbours
    bool operator<(const Candidate& other) const {
      return cosine < other.cosine || (cosine == other.cosine && corner > other.corner);
    }
  };

  Vec3 side(std::size_t from, std::size_t to) const {
    return polygon_.points[to] - polygon_.points[from];
  }

  // Unit normal of the ear at a corner; zero without area.
  Vec3 normal(std::size_t i) const {
    return unit_or_zero(side(before_[i], i).cross(side(i, after_[i])));
  }

  // Returns whether ears of any angle were not admitted before.
  bool admit_sharp_ears() {
    if (std::exchange(any_turn_, true)) return false;
    std::size_t i = after_[last_cut_];
    for (std::size_t k = 0; k < count_; ++k, i = after_[i]) look_at(i);
    return true;
  }

  void look_at(std::size_t i) {
    const int change = ++changes_[i];
    const std::size_t a = before_[i], b = after_[i];
    const Vec3 ear = normal(i), leaving = side(i, a), arriving = side(i, b);
    for (const Vec3& behind : {normals_[a], normals_[i]})
      if (!any_turn_ && !behind.isZero() && ear.dot(behind) < sharp_turn) return;
    if (ear.isZero() || !polygon_.may_join(std::min(a, b), std::max(a, b))) return;
    open_.push({leaving.dot(arriving) / (leaving.norm() * arriving.norm()), i, change});
  }

  const SpacePolygon& polygon_;
  std::vector<Vec3> normals_;  // of the face behind the side from each corner
  std::size_t count_, last_cut_ = 0;
  std::vector<std::size_t> before_, after_;
  std::vector<int> changes_;
  bool any_turn_ = false;
  std::priority_queue<Candidate> open_;
};

// Cuts off ears, the sharpest corner first, until `enough` corners are left: first those that turn
// by less than 60 degrees against the faces behind their two sides, then any. More corners are left
// only where no ear has an area and an allowed third side.
Shortened cut_ears(const SpacePolygon& polygon, std::size_t enough) {
  return Ears(polygon).cut(enough);
}

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
