// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fill/crossings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/roundoff.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Box = Eigen::AlignedBox3d;

class Cells {
 public:
  Cells(std::span<const Vec3> points, std::span<const Triangle> triangles, std::size_t first)
      : points_(points), triangles_(triangles), first_(first) {
    const auto count = double(triangles.size() - first);
    double extent = 0;
    for (std::size_t t = first; t < triangles.size(); ++t) {
      const Box box = box_of(t);
      whole_.extend(box);
      extent += box.sizes().maxCoeff() / count;
    }
    // a large triangle among small ones must not fill too many cells
    for (size_ = 2 * extent; size_ > 0 && filled_cells() > 8 * count;) size_ *= 2;
    if (size_ > 0)
      for (std::size_t t = first; t < triangles.size(); ++t)
        each_cell(box_of(t), [&](std::int64_t cell) { inside_[cell].push_back(t); });
  }

  std::vector<std::size_t> crossing() const {
    std::vector<std::uint8_t> found(triangles_.size(), 0);
    for (std::size_t t = 0; t < triangles_.size() && !inside_.empty(); ++t) {
      stop_if_cancelled(t);
      const Box box = box_of(t).intersection(whole_);
      if (box.isEmpty()) continue;
      const auto look_at = [&](std::size_t other) {
        if (other != t && !(found[t] && found[other]) && meet(t, other))
          found[t] = found[other] = 1;
      };
      if (cells_in(box) > double(triangles_.size() - first_)) {  // a large one among small ones
        for (std::size_t other = first_; other < triangles_.size(); ++other) look_at(other);
        continue;
      }
      each_cell(box, [&](std::int64_t cell) {
        const auto at = inside_.find(cell);
        if (at != inside_.end())
          for (const std::size_t other : at->second) look_at(other);
      });
    }
    std::vector<std::size_t> numbers;
    for (std::size_t t = first_; t < triangles_.size(); ++t)
      if (found[t]) numbers.push_back(t);
    return numbers;
  }

 private:
  const Vec3& corner(std::size_t t, std::size_t i) const { return points_[triangles_[t][i]]; }

  Box box_of(std::size_t t) const {
    Box box(corner(t, 0));
    return box.extend(corner(t, 1)).extend(corner(t, 2));
  }

  double cells_in(const Box& box) const { return (box.sizes().array() / size_ + 1).prod(); }

  double filled_cells() const {
    double sum = 0;
    for (std::size_t t = first_; t < triangles_.size(); ++t) sum += cells_in(box_of(t));
    return sum;
  }

  template <class Use>
  void each_cell(const Box& box, const Use& use) const {
    const auto place = [&](const Vec3& p) {
      return ((p - whole_.min()) / size_).array().floor().cast<std::int64_t>().eval();
    };
    const auto low = place(box.min()), high = place(box.max());
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z) use(x << 42 | y << 21 | z);
  }

  bool meet(std::size_t a, std::size_t b) const {
    for (const Index v : triangles_[a])
      if (std::find(triangles_[b].begin(), triangles_[b].end(), v) != triangles_[b].end())
        return false;
    if (!box_of(a).intersects(box_of(b))) return false;
    if (lie_on_one_another(a, b)) return true;
    return cross(a, b);
  }

  // Whether two triangles in a plane overlap: no side of either separates them.
  bool lie_on_one_another(std::size_t a, std::size_t b) const {
    for (const auto& [t, other] : {std::pair(a, b), std::pair(b, a)}) {
      const Vec3 normal = (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
      const double size = normal.norm(), thin = roundoff * size;
      if (size == 0) return false;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 way = corner(other, i) - corner(t, 0);
        if (std::abs(normal.dot(way)) > thin * (way.norm() + std::sqrt(size))) return false;
      }
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& from = corner(t, i);
        const Vec3 inwards = normal.cross(corner(t, (i + 1) % 3) - from);
        bool beyond = true;
        for (std::size_t k = 0; k < 3 && beyond; ++k) {
          const Vec3 way = corner(other, k) - from;
          beyond = inwards.dot(way) <= roundoff * inwards.norm() * way.norm();
        }
        if (beyond) return false;
      }
    }
    return true;
  }

  // Whether two triangles have corners on both sides of each other's plane, and a piece of the line
  // where these planes meet in common [Möller 1997].
  bool cross(std::size_t a, std::size_t b) const {
    const Vec3 of_a = normal(a), of_b = normal(b), line = of_a.cross(of_b);
    const Vec3& origin = corner(a, 0);
    const auto in_a = on_line(a, corner(b, 0), of_b, origin, line);
    if (in_a[0] >= in_a[1]) return false;
    const auto in_b = on_line(b, corner(a, 0), of_a, origin, line);
    const double length = std::min(in_a[1] - in_a[0], in_b[1] - in_b[0]);
    return std::min(in_a[1], in_b[1]) - std::max(in_a[0], in_b[0]) >
           roundoff * std::max(length, 0.0);
  }

  Vec3 normal(std::size_t t) const {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
  }

  // Where a triangle meets a plane `across` a normal, along `line` from `origin`; both ends are 0 if it
  // has no corners on both sides. Corners within rounding of the plane lie in it.
  std::array<double, 2> on_line(std::size_t t, const Vec3& in_plane, const Vec3& across,
                                const Vec3& origin, const Vec3& line) const {
    std::array<double, 3> height, place;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 way = corner(t, i) - in_plane;
      height[i] = across.dot(way);
      if (std::abs(height[i]) <= roundoff * across.norm() * way.norm()) height[i] = 0;
      place[i] = line.dot(corner(t, i) - origin);
    }
    const auto [low, high] = std::minmax_element(height.begin(), height.end());
    if (!(*low < 0 && *high > 0)) return {0, 0};
    std::array<double, 2> ends{std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = (i + 1) % 3;
      if (height[i] * height[k] > 0) continue;
      const double at = place[i] + (place[k] - place[i]) * (height[i] / (height[i] - height[k]));
      ends = {std::min(ends[0], at), std::max(ends[1], at)};
    }
    return ends;
  }

  std::span<const Vec3> points_;
  std::span<const Triangle> triangles_;
  std::size_t first_;
  Box whole_;
  double size_ = 0;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> inside_;
};

}  // namespace

std::vector<std::size_t> crossing(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                  std::size_t first) {
  return Cells(points, triangles, first).crossing();
}

}  // namespace fairing
