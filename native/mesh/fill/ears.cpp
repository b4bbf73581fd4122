// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fill/ears.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <queue>
#include <utility>

#include "base/points.h"
#include "mesh/sharp_turn.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

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

}  // namespace

Shortened cut_ears(const SpacePolygon& polygon, std::size_t enough) {
  return Ears(polygon).cut(enough);
}

}  // namespace fairing
