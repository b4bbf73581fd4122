// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fill/ruled.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/points.h"
#include "mesh/sharp_turn.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Line = std::pair<Index, Index>;  // from one rim to the other

// The lines between two rims.
class Ring {
 public:
  Ring(const std::vector<Vec3>& points, std::size_t second,
       const std::function<bool(std::size_t, std::size_t)>& may_join)
      : points_(points), m_(points.size() - second), n_(second), may_join_(may_join) {}

  // From the shortest line around both rims and back to it: at step (i, j) the line connects the
  // i-th vertex of one rim to the j-th of the other, backwards.
  std::vector<Line> run() {
    if (!begin()) return {};
    std::vector<double> least(m_ + 1, unreachable);
    forward_.assign((n_ + 1) * (m_ + 1), 0);
    for (std::size_t i = 0; i <= n_; ++i) {
      stop_if_cancelled();
      for (std::size_t j = 0; j <= m_; ++j) {
        if (i + j == 0) {
          least[0] = 0;
          continue;
        }
        const double over = i ? least[j] : unreachable, along = j ? least[j - 1] : unreachable;
        forward_[i * (m_ + 1) + j] = over <= along;
        least[j] = std::min(over, along) + squared_length(i, j);
      }
    }
    return least[m_] < unreachable ? lines() : std::vector<Line>();
  }

 private:
  static constexpr double unreachable = std::numeric_limits<double>::infinity();

  std::size_t one(std::size_t i) const { return (first_ + i) % n_; }
  std::size_t other(std::size_t j) const { return n_ + (last_ + m_ - j % m_) % m_; }

  double squared_length(std::size_t i, std::size_t j) const {
    const bool closed_too_early = (i == 0 && j == m_) || (i == n_ && j == 0);
    if (closed_too_early || !may_join_(one(i), other(j))) return unreachable;
    return (points_[one(i)] - points_[other(j)]).squaredNorm();
  }

  bool begin() {
    double least = unreachable;
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < m_; ++j) {
        const double length = (points_[i] - points_[n_ + j]).squaredNorm();
        if (length < least && may_join_(i, n_ + j)) least = length, first_ = i, last_ = j;
      }
    return least < unreachable;
  }

  // In order; the last one equals the first. Empty if one occurs twice.
  std::vector<Line> lines() const {
    std::vector<Line> found{{Index(one(0)), Index(other(0))}};
    std::set<Line> known;
    for (std::size_t i = n_, j = m_; i + j > 0; --(forward_[i * (m_ + 1) + j] ? i : j)) {
      found.push_back({Index(one(i)), Index(other(j))});
      if (!known.insert(found.back()).second) return {};
    }
    std::reverse(found.begin() + 1, found.end());
    return found;
  }

  const std::vector<Vec3>& points_;
  std::size_t m_, n_;  // numbers of vertices of the second and the first rim
  const std::function<bool(std::size_t, std::size_t)>& may_join_;
  std::size_t first_ = 0, last_ = 0;   // ends of the shortest line
  std::vector<std::uint8_t> forward_;  // whether the best path to a step came along the first rim
};

// A cubic curve between the rims that continues the faces behind both of them; for the turn of an
// arc it is nearly that arc.
class Bend {
 public:
  Bend(const Vec3& from, const Vec3& to, const Vec3& leaving, const Vec3& arriving)
      : from_(from), to_(to) {
    const double cosine =
        std::sqrt(std::max(0.0, 1 + leaving.dot(arriving)) / 2);  // of half the turn
    const double speed = 2 * (to - from).norm() / (1 + cosine);
    leaving_ = speed * leaving, arriving_ = speed * arriving;
  }
  Vec3 at(double t) const {
    const double s = 1 - t;
    return s * s * (1 + 2 * t) * from_ + t * t * (3 - 2 * t) * to_ + s * s * t * leaving_ -
           s * t * t * arriving_;
  }
  double length() const {
    const Vec3 middle = at(0.5);
    return (middle - from_).norm() + (to_ - middle).norm();
  }

 private:
  Vec3 from_, to_, leaving_, arriving_;
};

// Direction in which the faces behind continue at each point of a rim: unit length, into the ring.
void onward(const Patch& patch, std::size_t begin, std::size_t end, std::vector<Vec3>& found) {
  const auto across = [&](std::size_t i, std::size_t next) {
    return Vec3(patch.rim_normals[i].cross(patch.points[next] - patch.points[i]));
  };
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t before = i == begin ? end - 1 : i - 1, next = i + 1 == end ? begin : i + 1;
    found.push_back(unit_or_zero(across(before, i) + across(i, next)));
  }
}

// Adds the triangles between lines of `rows` pieces each.
void join(Patch& patch, const std::vector<Line>& lines, std::size_t rows) {
  const auto count = lines.size() - 1;
  const auto place = [&](std::size_t line, std::size_t row) {
    if (row == 0) return lines[line].first;
    if (row == rows) return lines[line].second;
    return Index(std::size_t(patch.rim) + (line % count) * (rows - 1) + row - 1);
  };
  for (std::size_t line = 0; line < count; ++line)
    for (std::size_t row = 0; row < rows; ++row) {
      const Index a = place(line, row), b = place(line + 1, row), c = place(line + 1, row + 1),
                  d = place(line, row + 1);
      if (a != b) patch.triangles.push_back({a, b, c});
      if (c != d) patch.triangles.push_back({a, c, d});
    }
}

Patch bent(const Patch& rims, std::size_t second, const std::vector<Line>& lines) {
  Patch patch = rims;
  std::vector<Vec3> ways;
  onward(rims, 0, second, ways);
  onward(rims, second, rims.points.size(), ways);
  std::vector<Bend> bends;
  double longest = 0, wanted = 0;
  for (std::size_t l = 0; l + 1 < lines.size(); ++l) {
    const auto a = std::size_t(lines[l].first), b = std::size_t(lines[l].second);
    bends.emplace_back(rims.points[a], rims.points[b], ways[a], -ways[b]);
    longest = std::max(longest, bends.back().length());
    wanted += (rims.lengths[a] + rims.lengths[b]) / 2 / double(lines.size() - 1);
  }
  const double pieces = std::ceil(longest / wanted);
  if (!(pieces * double(lines.size()) <= double(largest_filling))) too_dense();
  const auto rows = std::max<std::size_t>(1, std::size_t(pieces));
  for (std::size_t l = 0; l < bends.size(); ++l)
    for (std::size_t row = 1; row < rows; ++row) {
      const double t = double(row) / double(rows);
      patch.points.push_back(bends[l].at(t));
      patch.lengths.push_back((1 - t) * rims.lengths[lines[l].first] +
                              t * rims.lengths[lines[l].second]);
    }
  join(patch, lines, rows);
  return patch;
}

// The least cosine of turns between triangles, and between them and the faces behind the rims.
struct Turns {
  double between = 1, behind = 1;
};

Turns sharpest(const Patch& patch) {
  std::map<Line, Vec3> sides;
  Turns found;
  for (const Triangle& t : patch.triangles) {
    const Vec3& a = patch.points[t[0]];
    const Vec3 normal = unit_or_zero((patch.points[t[1]] - a).cross(patch.points[t[2]] - a));
    for (std::size_t i = 0; i < 3; ++i) {
      const auto other = sides.find({t[(i + 1) % 3], t[i]});
      if (other == sides.end()) {
        sides[{t[i], t[(i + 1) % 3]}] = normal;
        continue;
      }
      found.between = std::min(found.between, normal.dot(other->second));
      sides.erase(other);
    }
  }
  for (const auto& [side, normal] : sides)
    if (const Vec3& behind = patch.rim_normals[side.first]; !behind.isZero())
      found.behind = std::min(found.behind, normal.dot(behind));
  return found;
}

}  // namespace

bool fill_ring(Patch& patch, std::size_t second, bool bends,
               const std::function<bool(std::size_t, std::size_t)>& may_join) {
  const std::vector<Line> lines = Ring(patch.points, second, may_join).run();
  if (lines.empty()) return false;
  Patch straight = patch;
  join(straight, lines, 1);
  const Turns turns = sharpest(straight);
  const double worst = std::min(turns.between, turns.behind);
  if (bends && worst < sharp_turn) {
    Patch other = bent(patch, second, lines);
    const Turns less = sharpest(other);
    if (std::min(less.between, less.behind) > worst) {
      patch = std::move(other);
      return true;
    }
  }
  if (turns.between < 0) return false;
  patch = std::move(straight);
  return true;
}

}  // namespace fairing
