// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/angle.h"

namespace fairing {
namespace {

double sine(const Vec3& a, const Vec3& b) { return a.normalized().cross(b.normalized()).norm(); }

// Direction at `end` of an arc that turns evenly along a polyline's last two chords, of unit length; it
// goes on from there. All parallels to the polyline have the same one, as insets of an outline do. The
// arc turns by half as much from its last chord to its tangent as from chord to chord.
Vec3 tangent_of_arc(const Vec3& first, const Vec3& middle, const Vec3& end) {
  const Vec3 chord = (end - middle).normalized();
  const Vec3 before = (chord + (middle - first).normalized()).normalized();
  return 2 * chord.dot(before) * chord - before;
}

class Lines {
 public:
  Lines(std::span<const Vec3> vertices, bool closed, const Beyond& beyond)
      : vertices_(vertices),
        beyond_(beyond),
        closed_(closed),
        count_(int(vertices.size())),
        segments_(closed ? count_ : count_ - 1) {}

  std::vector<std::uint8_t> tangent() const {
    const std::vector<int> joints = joints_of_lines();  // line i goes from joint i to i + 1
    const std::size_t lines = joints.size() - 1;
    std::vector<std::uint8_t> tangent(lines, 0), out(std::size_t(segments_), 0);
    for (std::size_t i = 0; i < lines; ++i) tangent[i] = is_tangent(joints[i], joints[i + 1]);
    for (std::size_t i = 0; i < lines; ++i) {
      // Two lines that meet at an angle have no arc that they could be tangent to.
      const bool meets_line = (i > 0 || closed_) && tangent[(i + lines - 1) % lines];
      const bool line_meets = (i + 1 < lines || closed_) && tangent[(i + 1) % lines];
      if (tangent[i] && !meets_line && !line_meets)
        for (int s = joints[i]; s < joints[i + 1]; ++s) out[std::size_t(s % segments_)] = 1;
    }
    return out;
  }

 private:
  const Vec3& at(int vertex) const { return vertices_[std::size_t((vertex + count_) % count_)]; }
  bool has(int vertex) const { return closed_ || (vertex >= 0 && vertex < count_); }

  bool is_collinear(int j) const {
    if (!has(j - 1) || !has(j + 1)) return false;
    const Vec3 before = at(j) - at(j - 1), after = at(j + 1) - at(j);
    return before.dot(after) > 0 && sine(before, after) <= turn_of_rounding(at(j - 1), at(j)) +
                                                               turn_of_rounding(at(j), at(j + 1));
  }

  std::vector<int> joints_of_lines() const {
    int start = 0;
    while (closed_ && start < segments_ && is_collinear(start)) ++start;
    std::vector<int> joints = {start};
    for (int j = start + 1; j < start + segments_; ++j)
      if (!is_collinear(j)) joints.push_back(j);
    joints.push_back(start + segments_);
    return joints;
  }

  bool is_tangent(int first, int last) const {
    const bool begins = !has(first - 1), ends = !has(last + 1);
    return !(begins && ends) && (begins || meets_arc(last, first, -1)) &&
           (ends || meets_arc(first, last, 1));
  }

  // Whether the line from vertex `from` to vertex `to` is tangent to the arc that follows, in the
  // direction `step`, but for rounding: smooth curves meet any tolerance by chance.
  bool meets_arc(int from, int to, int step) const {
    const Vec3 line = at(from) - at(to);
    const auto is_arc = [&](const Vec3& first) {
      const Vec3 &end = at(to), &middle = at(to + step);
      const Vec3 arc = tangent_of_arc(first, middle, end);
      return line.dot(arc) > 0 &&
             sine(line, arc) <= turn_of_rounding(first, middle) + 2 * turn_of_rounding(middle, end);
    };
    if (has(to + 2 * step)) return is_arc(at(to + 2 * step));
    const std::vector<Vec3>& beyond = step > 0 ? beyond_.last : beyond_.first;
    return std::any_of(beyond.begin(), beyond.end(), is_arc);
  }

  std::span<const Vec3> vertices_;
  const Beyond& beyond_;
  bool closed_;
  int count_, segments_;
};

}  // namespace

std::vector<std::uint8_t> tangent_lines(std::span<const Vec3> vertices, bool closed,
                                        const Beyond& beyond) {
  return Lines(vertices, closed, beyond).tangent();
}

}  // namespace fairing
