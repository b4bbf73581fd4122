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

// Number of corners for which all pairs are considered: 0.2 s. Longer polygons lose ears first.
constexpr std::size_t longest_whole = 400;

// The rest of a polygon.
struct Shortened {
  std::vector<Triangle> ears;  // corners, ascending
  std::vector<Index> corners;  // the remaining ones, in their order
  std::vector<Vec3> normals;   // of the face behind the side from each of these to the next
};

// Shortens a ragged polygon by ears, the sharpest corner first, until `enough` corners are left or
// none may be cut. At first only smooth ears: they turn by less than 60 degrees against the faces
// behind both sides.
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
      stop_if_cancelled(count_);
      if (open_.empty()) {
        if (std::exchange(may_fold_, true)) break;
        for (std::size_t i = after_[last_cut_], k = 0; k < count_; ++k, i = after_[i]) look_at(i);
        continue;
      }
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
    for (const Index corner : found.corners) found.normals.push_back(normals_[std::size_t(corner)]);
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

  void look_at(std::size_t i) {
    const int change = ++changes_[i];
    const std::size_t a = before_[i], b = after_[i];
    const Vec3 ear = normal(i), leaving = side(i, a), arriving = side(i, b);
    for (const Vec3& behind : {normals_[a], normals_[i]})
      if (!may_fold_ && !behind.isZero() && ear.dot(behind) < sharp_turn) return;
    if (ear.isZero() || !polygon_.may_join(std::min(a, b), std::max(a, b))) return;
    open_.push({leaving.dot(arriving) / (leaving.norm() * arriving.norm()), i, change});
  }

  const SpacePolygon& polygon_;
  std::vector<Vec3> normals_;  // of the face behind the side from each corner
  std::size_t count_, last_cut_ = 0;
  std::vector<std::size_t> before_, after_;
  std::vector<int> changes_;
  std::priority_queue<Candidate> open_;
  bool may_fold_ = false;  // once no smooth ear is left
};

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

class Search {
 public:
  explicit Search(const SpacePolygon& polygon)
      : polygon_(polygon),
        size_(polygon.points.size()),
        best_(size_ * size_),
        by_start_(size_ * size_),
        by_end_(size_ * size_) {}

  std::vector<Triangle> run() {
    for (std::size_t i = 0; i + 1 < size_; ++i) {
      at(i, i + 1) = {{0, 1, 0}, Index(i), polygon_.normals[i]};
      note(i, i + 1);
    }
    for (std::size_t gap = 2; gap < size_; ++gap)
      for (std::size_t low = 0; low + gap < size_; ++low) {
        stop_if_cancelled();
        look_at(low, low + gap);
      }
    return triangles();
  }

 private:
  Best& at(std::size_t low, std::size_t high) { return best_[low * size_ + high]; }

  // Copies the cost of a chord, in the order in which look_at() reads them: those from `low` by
  // length, and those to `high`.
  void note(std::size_t low, std::size_t high) {
    by_start_[low * size_ + high - low - 1] = by_end_[high * size_ + high - low - 1] =
        at(low, high).cost;
  }

  void look_at(std::size_t low, std::size_t high) {
    if (high - low + 1 < size_ && !polygon_.may_join(low, high)) return;
    const Cost *from = &by_start_[low * size_], *to = &by_end_[high * size_];
    for (std::size_t middle = low + 1; middle < high; ++middle) {
      const Cost parts = from[middle - low - 1] + to[high - middle - 1];
      if (parts.is_less_than(at(low, high).cost)) consider(low, middle, high, parts);
    }
    note(low, high);
  }

  // The triangle of three corners, with these `parts` beyond its other two sides.
  void consider(std::size_t low, std::size_t middle, std::size_t high, const Cost& parts) {
    const std::vector<Vec3>& p = polygon_.points;
    Vec3 normal = (p[middle] - p[low]).cross(p[high] - p[low]);
    const double length = normal.norm();
    if (length > 0) normal /= length;
    double turns[] = {turn(normal, at(low, middle).normal), turn(normal, at(middle, high).normal),
                      1};
    if (high - low + 1 == size_) turns[2] = turn(normal, polygon_.normals[high]);
    Cost cost = parts;
    for (const double t : turns) {
      cost.folding += std::max(0.0, -t);
      cost.cosine = std::min(cost.cosine, t);
    }
    cost.area += length / 2;
    if (Best& best = at(low, high); cost.is_less_than(best.cost))
      best = {cost, Index(middle), normal};
  }

  // The cosine between two normals, in steps, so that rounding does not decide in flat holes. A
  // triangle without area counts as the worst.
  static double turn(const Vec3& normal, const Vec3& other) {
    if (other.isZero()) return 1;
    return normal.isZero() ? -1 : std::round(normal.dot(other) / single_roundoff) * single_roundoff;
  }

  std::vector<Triangle> triangles() {
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
  std::vector<Best> best_;  // of the chord between two corners, the lower one first
  std::vector<Cost> by_start_, by_end_;
};

}  // namespace

std::vector<Triangle> triangulate(const SpacePolygon& polygon) {
  if (polygon.points.size() < 3) return {};
  if (polygon.points.size() <= longest_whole) return Search(polygon).run();
  const auto of_rest = [&polygon](Shortened rest) -> std::vector<Triangle> {
    if (rest.corners.size() > longest_whole) return {};
    SpacePolygon left;
    for (const Index corner : rest.corners)
      left.points.push_back(polygon.points[std::size_t(corner)]);
    left.normals = std::move(rest.normals);
    left.may_join = [&](std::size_t low, std::size_t high) {
      return polygon.may_join(std::size_t(rest.corners[low]), std::size_t(rest.corners[high]));
    };
    const std::vector<Triangle> inner = Search(left).run();
    if (inner.empty()) return {};
    for (const Triangle& t : inner)
      rest.ears.push_back({rest.corners[std::size_t(t[0])], rest.corners[std::size_t(t[1])],
                           rest.corners[std::size_t(t[2])]});
    return std::move(rest.ears);
  };
  std::vector<Triangle> found = of_rest(Ears(polygon).cut(longest_whole));
  return found.empty() ? of_rest(Ears(polygon).cut(3)) : found;
}

}  // namespace fairing
