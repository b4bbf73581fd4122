// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mend/dissolve.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/points.h"
#include "base/roundoff.h"
#include "mesh/mend/cut_sides.h"
#include "mesh/mend/merge.h"
#include "mesh/validate/checks.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

class EdgeFaces {
 public:
  using Key = std::uint64_t;

  static Key key(Index a, Index b) {
    return Key(std::uint32_t(std::min(a, b))) << 32 | std::uint32_t(std::max(a, b));
  }

  explicit EdgeFaces(const Loops& loops) {
    sides_.reserve(loops.corners.size());
    for (Index f = 0; f < loops.count(); ++f)
      for_sides(loops.face(f), [&](Key side) { sides_.push_back({side, f}); });
    std::sort(sides_.begin(), sides_.end());
  }

  // Adds a new face, or a new side of a face.
  void add(std::span<const MendCorner> loop, Index f) {
    for_sides(loop, [&](Key side) { added_[side].push_back(f); });
  }
  void add(Index a, Index b, Index f) { added_[key(a, b)].push_back(f); }

  // All faces that ever had this side, ascending; the caller checks whether they still have it.
  std::vector<Index> around(Index a, Index b) const {
    std::vector<Index> faces;
    const Key side = key(a, b);
    for (auto at = std::lower_bound(sides_.begin(), sides_.end(), std::pair<Key, Index>(side, -1));
         at != sides_.end() && at->first == side; ++at)
      faces.push_back(at->second);
    if (const auto later = added_.find(side); later != added_.end())
      faces.insert(faces.end(), later->second.begin(), later->second.end());
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
  }

 private:
  template <class Visit>
  static void for_sides(std::span<const MendCorner> loop, Visit&& visit) {
    for (std::size_t i = 0; i < loop.size(); ++i)
      visit(key(loop[i].vertex, loop[(i + 1) % loop.size()].vertex));
  }

  Array<std::pair<Key, Index>> sides_;
  std::unordered_map<Key, std::vector<Index>> added_;
};

// A face in the queue, the longest first: so its vertices go into faces that stay, not into others
// that are dissolved later. Its place does not depend on the order of faces.
struct Waiting {
  double longest_side;
  std::vector<Index> vertices;
  Index face;
  bool operator<(const Waiting& other) const {
    if (longest_side != other.longest_side) return longest_side > other.longest_side;
    return vertices != other.vertices ? vertices < other.vertices : face < other.face;
  }
};

bool is_flat(std::span<const double> coordinates, std::span<const MendCorner> loop,
             std::vector<std::int64_t>& ids) {
  ids.clear();
  for (const MendCorner& corner : loop) ids.push_back(corner.vertex);
  return has_no_area(coordinates, ids);
}

std::vector<Index> flat_faces(std::span<const double> coordinates, const Loops& loops) {
  std::vector<Index> found;
  std::vector<std::int64_t> ids;
  for (const Index f : Cancellable(loops.count())) {
    if (is_flat(coordinates, loops.face(f), ids)) found.push_back(f);
  }
  return found;
}

class Dissolver {
 public:
  Dissolver(std::span<const double> coordinates, const Loops& loops)
      : coordinates_(coordinates),
        loops_(loops),
        edges_(loops),
        changed_at_(std::size_t(loops.count()), -1),
        state_(std::size_t(loops.count()), State::sound) {}

  Dissolved run(const std::vector<Index>& flat) {
    for (const Index f : flat) wait(f, face(f));
    // Enough for any mesh that was not constructed to exceed it.
    std::size_t left = 16 * loops_.corners.size() + 1024;
    for (; left > 0; --left) {
      if (waiting_.empty()) cut_sides_of_faces();
      if (waiting_.empty()) break;
      stop_if_cancelled(left);
      const Index f = waiting_.begin()->face;
      waiting_.erase(waiting_.begin());
      const Loop loop(face(f).begin(), face(f).end());
      if (loop.empty() || !is_flat(coordinates_, loop, ids_)) continue;
      done_.faces.push_back(origin(f));
      if (!on_a_line(loop))
        cut(f, loop);
      else
        dissolve(f, loop);
    }
    finish();
    return std::move(done_);
  }

  // The remaining faces, those of one origin together.
  Loops result() const {
    std::vector<Index> order(changed_at_.size());
    std::iota(order.begin(), order.end(), Index(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return origin(a) < origin(b); });
    Loops out;
    for (const std::size_t i : Cancellable(order.size())) {
      if (!face(order[i]).empty()) out.add(face(order[i]), origin(order[i]));
    }
    return out;
  }

 private:
  Vec3 point(Index v) const { return point_at(coordinates_, v); }
  // Valid until the next change.
  std::span<const MendCorner> face(Index f) const {
    const Index at = changed_at_[f];
    return at < 0 ? loops_.face(f) : std::span<const MendCorner>(changed_[at]);
  }
  Index origin(Index f) const {
    return f < loops_.count() ? loops_.origin[f] : new_origin_[f - loops_.count()];
  }

  // The test for a convex polygon without area, which is no wider.
  bool on_a_line(const Loop& loop) const {
    if (loop.size() == 3) return true;
    const auto farthest_from = [&](const Vec3& p) {
      Vec3 farthest = p;
      for (const MendCorner& corner : loop)
        if ((point(corner.vertex) - p).norm() > (farthest - p).norm())
          farthest = point(corner.vertex);
      return farthest;
    };
    const Vec3 begin = farthest_from(point(loop[0].vertex)), along = farthest_from(begin) - begin;
    return std::all_of(loop.begin(), loop.end(), [&](const MendCorner& corner) {
      return along.cross(point(corner.vertex) - begin).norm() <= 2 * roundoff * along.squaredNorm();
    });
  }

  void wait(Index f, std::span<const MendCorner> loop) {
    state_[f] = State::flat;
    Waiting one{0, {}, f};
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Index here = loop[i].vertex, next = loop[(i + 1) % loop.size()].vertex;
      one.longest_side = std::max(one.longest_side, (point(here) - point(next)).norm());
      one.vertices.push_back(here);
    }
    std::sort(one.vertices.begin(), one.vertices.end());
    waiting_.insert(std::move(one));
  }

  void set(Index f, Loop loop) {
    Index& at = changed_at_[f];
    if (at < 0) {
      at = Index(changed_.size());
      changed_.emplace_back();
    }
    state_[f] = State::sound;
    if (!loop.empty() && is_flat(coordinates_, loop, ids_)) wait(f, loop);
    changed_[at] = std::move(loop);
  }
  // Replaces a face by the first of several; the others are appended.
  void replace(Index f, std::vector<Loop> loops) {
    const Index from = origin(f);
    if (loops.empty()) return set(f, {});
    for (std::size_t i = 0; i < loops.size(); ++i) {
      if (i > 0) {
        new_origin_.push_back(from);
        changed_at_.push_back(-1);
        state_.push_back(State::sound);
      }
      const Index to = i == 0 ? f : Index(changed_at_.size()) - 1;
      edges_.add(loops[i], to);
      set(to, std::move(loops[i]));
    }
  }

  void dissolve(Index f, const Loop& loop) {
    set(f, {});
    const std::vector<Index> vertices = vertices_of(loop);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      CutSide side = cut_side(coordinates_, vertices[i], vertices[(i + 1) % loop.size()], vertices);
      if (side.between.empty()) continue;
      for (const Index other : edges_.around(side.low, side.high)) {
        if (state_[other] == State::flat)
          insert(other, side);
        else
          cut_later(other);
      }
      cut_.add(std::move(side));
    }
  }
  void cut_later(Index f) {
    if (std::exchange(state_[f], State::to_cut) == State::sound) to_cut_.push_back(f);
  }

  // Inserts the vertices inside the sides of faces with an area, once no flat face is left: a side
  // may be cut many times, and faces become long.
  void cut_sides_of_faces() {
    std::vector<Index> faces = std::move(to_cut_);
    to_cut_.clear();
    std::sort(faces.begin(), faces.end());
    for (const Index f : faces) {
      if (state_[f] != State::to_cut) continue;
      state_[f] = State::sound;
      expand(f);
    }
  }
  void expand(Index f) {
    Loop longer = cut_.expanded(face(f));
    if (longer.size() > face(f).size()) replace(f, without_repeats(std::move(longer)));
  }

  static std::vector<Loop> without_repeats(Loop loop) {
    std::vector<Index> vertices = vertices_of(loop);
    std::sort(vertices.begin(), vertices.end());
    if (std::adjacent_find(vertices.begin(), vertices.end()) != vertices.end())
      return simple_loops(loop);
    return {std::move(loop)};
  }

  // Inserts the vertices inside this side into a flat face that still has it in either direction.
  void insert(Index f, const CutSide& side) {
    const auto loop = face(f);
    Loop longer;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      stop_if_cancelled(++steps_);
      const MendCorner &here = loop[i], &next = loop[(i + 1) % loop.size()];
      longer.push_back(here);
      if (std::min(here.vertex, next.vertex) != side.low ||
          std::max(here.vertex, next.vertex) != side.high)
        continue;
      for (const MendCorner& corner : corners_between(side, here, next)) longer.push_back(corner);
    }
    if (longer.size() == loop.size()) return;
    const auto meets = [&](const MendCorner& corner) {
      return std::any_of(side.between.begin(), side.between.end(),
                         [&](const Between& one) { return one.vertex == corner.vertex; });
    };
    if (std::any_of(loop.begin(), loop.end(), meets)) return replace(f, simple_loops(longer));
    Index from = side.low;
    for (const Between& one : side.between) {
      edges_.add(from, one.vertex, f);
      from = one.vertex;
    }
    edges_.add(from, side.high, f);
    set(f, std::move(longer));
  }

  // Cuts a face into triangles at its lowest corner; a quad along the diagonal with larger halves.
  void cut(Index f, const Loop& loop) {
    const auto lower = [](const MendCorner& a, const MendCorner& b) { return a.vertex < b.vertex; };
    auto hub = std::size_t(std::min_element(loop.begin(), loop.end(), lower) - loop.begin());
    if (loop.size() == 4 && smaller_half(loop, hub + 1) > smaller_half(loop, hub)) ++hub;
    const auto corner = [&](std::size_t i) { return loop[(hub + i) % loop.size()]; };
    std::vector<Loop> triangles;
    for (std::size_t i = 1; i + 1 < loop.size(); ++i)
      triangles.push_back({corner(0), corner(i), corner(i + 1)});
    replace(f, std::move(triangles));
  }
  double smaller_half(const Loop& quad, std::size_t hub) const {
    const auto at = [&](std::size_t i) { return point(quad[(hub + i) % 4].vertex); };
    const Vec3 diagonal = at(2) - at(0);
    return std::min(diagonal.cross(at(1) - at(0)).norm(), diagonal.cross(at(3) - at(0)).norm());
  }

  void finish() {
    auto& faces = done_.faces;
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    done_.cut_edges = cut_.edges();
  }

  std::span<const double> coordinates_;
  const Loops& loops_;
  EdgeFaces edges_;
  // For each face the place of its loop in changed_, which is empty if the face is gone, or -1 if
  // it is unchanged. New faces are numbered after the others.
  Array<Index> changed_at_;
  std::vector<Loop> changed_;
  std::vector<Index> new_origin_;
  enum class State : std::uint8_t { sound, flat, to_cut };
  Array<State> state_;
  std::set<Waiting> waiting_;
  std::vector<Index> to_cut_;
  CutSides cut_;
  std::size_t steps_ = 0;  // since the last check for cancellation
  Dissolved done_;
  std::vector<std::int64_t> ids_;
};

}  // namespace

Dissolved dissolve_flat_faces(std::span<const double> coordinates, Loops& loops) {
  const std::vector<Index> flat = flat_faces(coordinates, loops);
  if (flat.empty()) return {};
  Dissolver dissolver(coordinates, loops);
  Dissolved done = dissolver.run(flat);
  loops = dissolver.result();
  return done;
}

}  // namespace fairing
