// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mend/dissolve.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "mesh/mend/edge_faces.h"
#include "mesh/validate/checks.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

// A polygon no wider than this, of its length, is a line.
constexpr double least_width = 1e-9;

// A vertex inside a side of a face, and how far along.
struct Between {
  double share;
  Index vertex;
  bool operator<(const Between& other) const {
    return share != other.share ? share < other.share : vertex < other.vertex;
  }
};

// Where a corner is along the input's side from one corner to another; -1: not on it.
double place_on(const CornerOrigin& origin, Index from, Index to) {
  if (origin.share == 0) return origin.from == from ? 0 : origin.from == to ? 1 : -1;
  if (origin.from == from && origin.beside == to) return origin.share;
  return origin.from == to && origin.beside == from ? 1 - origin.share : -1;
}

// Of a corner so far along from corner a to the next, b.
CornerOrigin origin_between(const CornerOrigin& a, const CornerOrigin& b, double share) {
  const bool cut = a.share != 0 || b.share == 0;
  const Index from = a.share == 0 && b.share != 0 ? b.from : a.from;
  const Index to = a.share != 0 ? a.beside : cut ? b.from : b.beside;
  const double begin = place_on(a, from, to), end = place_on(b, from, to);
  if (begin < 0 || end < 0) return share < 0.5 ? a : b;
  return {from, to, begin + share * (end - begin)};
}

// A face whose turn comes, the longest first: then its vertices go into faces that stay, rather than
// into others that go. Its place does not depend on the order of faces.
struct Waiting {
  double longest_side;
  std::vector<Index> vertices;
  Index face;
  bool operator<(const Waiting& other) const {
    if (longest_side != other.longest_side) return longest_side > other.longest_side;
    return vertices != other.vertices ? vertices < other.vertices : face < other.face;
  }
};

// A side of faces, and what lies inside it, in order from `low`.
struct CutSide {
  Index low, high;
  std::vector<Between> between;
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
  for (Index f = 0; f < loops.count(); ++f) {
    stop_if_cancelled(std::size_t(f));
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
        changed_at_(std::size_t(loops.count()), -1) {}

  Dissolved run(const std::vector<Index>& flat) {
    for (const Index f : flat) wait(f, face(f));
    // Enough for any mesh that was not made to defeat it.
    std::size_t left = 16 * loops_.corners.size() + 1024;
    for (; !waiting_.empty() && left > 0; --left) {
      stop_if_cancelled(left);
      const Index f = waiting_.begin()->face;
      waiting_.erase(waiting_.begin());
      const Loop loop(face(f).begin(), face(f).end());
      if (loop.empty() || !is_flat(coordinates_, loop, ids_)) continue;
      done_.faces.push_back(origin(f));
      if (on_a_line(loop))
        dissolve(f, loop);
      else
        cut(f, loop);
    }
    finish();
    return std::move(done_);
  }

  // The faces that are left, those of one origin together.
  Loops result() const {
    std::vector<Index> order(changed_at_.size());
    std::iota(order.begin(), order.end(), Index(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return origin(a) < origin(b); });
    Loops out;
    for (std::size_t i = 0; i < order.size(); ++i) {
      stop_if_cancelled(i);
      if (!face(order[i]).empty()) out.add(face(order[i]), origin(order[i]));
    }
    return out;
  }

 private:
  Vec3 point(Index v) const { return Eigen::Map<const Vec3>(&coordinates_[3 * std::size_t(v)]); }
  // Valid until the next change.
  std::span<const MendCorner> face(Index f) const {
    const Index at = changed_at_[std::size_t(f)];
    return at < 0 ? loops_.face(f) : std::span<const MendCorner>(changed_[std::size_t(at)]);
  }
  Index origin(Index f) const {
    return f < loops_.count() ? loops_.origin[std::size_t(f)]
                              : new_origin_[std::size_t(f - loops_.count())];
  }

  bool on_a_line(const Loop& loop) const {
    if (loop.size() == 3) return true;
    const auto farthest_from = [&](const Vec3& p) {
      Vec3 farthest = p;
      for (const MendCorner& corner : loop)
        if ((point(corner.vertex) - p).norm() > (farthest - p).norm())
          farthest = point(corner.vertex);
      return farthest;
    };
    const Vec3 begin = farthest_from(point(loop[0].vertex)), way = farthest_from(begin) - begin;
    return std::all_of(loop.begin(), loop.end(), [&](const MendCorner& corner) {
      return way.cross(point(corner.vertex) - begin).norm() <= least_width * way.squaredNorm();
    });
  }

  void wait(Index f, std::span<const MendCorner> loop) {
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
    Index& at = changed_at_[std::size_t(f)];
    if (at < 0) {
      at = Index(changed_.size());
      changed_.emplace_back();
    }
    if (!loop.empty() && is_flat(coordinates_, loop, ids_)) wait(f, loop);
    changed_[std::size_t(at)] = std::move(loop);
  }
  // The first of several faces in the place of one, the others beside it.
  void replace(Index f, std::vector<Loop> loops) {
    const Index from = origin(f);
    if (loops.empty()) return set(f, {});
    for (std::size_t i = 0; i < loops.size(); ++i) {
      if (i > 0) {
        new_origin_.push_back(from);
        changed_at_.push_back(-1);
      }
      const Index to = i == 0 ? f : Index(changed_at_.size()) - 1;
      edges_.add(loops[i], to);
      set(to, std::move(loops[i]));
    }
  }

  void dissolve(Index f, const Loop& loop) {
    set(f, {});
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const CutSide side = cut_side(loop, loop[i].vertex, loop[(i + 1) % loop.size()].vertex);
      if (side.between.empty()) continue;
      for (const Index other : edges_.around(side.low, side.high)) insert(other, side);
      auto& known = cut_[{side.low, side.high}];
      known.clear();
      for (const Between& one : side.between) known.push_back(one.vertex);
    }
  }

  // The side between two corners, with all others that lie strictly inside it.
  CutSide cut_side(const Loop& loop, Index a, Index b) const {
    CutSide side{std::min(a, b), std::max(a, b), {}};
    const Vec3 begin = point(side.low), way = point(side.high) - begin;
    for (const MendCorner& corner : loop) {
      if (corner.vertex == a || corner.vertex == b) continue;
      const double share = way.dot(point(corner.vertex) - begin) / way.squaredNorm();
      if (share > 0 && share < 1) side.between.push_back({share, corner.vertex});
    }
    std::sort(side.between.begin(), side.between.end());
    return side;
  }

  // Gives a face, if it still has this side whichever way round, the vertices inside it.
  void insert(Index f, const CutSide& side) {
    const auto loop = face(f);
    const std::size_t more = side.between.size();
    Loop longer;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const MendCorner &here = loop[i], &next = loop[(i + 1) % loop.size()];
      longer.push_back(here);
      const bool ahead = here.vertex == side.low && next.vertex == side.high;
      if (!ahead && !(here.vertex == side.high && next.vertex == side.low)) continue;
      for (std::size_t k = 0; k < more; ++k) {
        const Between& one = side.between[ahead ? k : more - 1 - k];
        const double share = ahead ? one.share : 1 - one.share;
        longer.push_back({one.vertex, origin_between(here.origin, next.origin, share)});
      }
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

  // Into triangles about the lowest corner; of a quad's two diagonals, along that with the larger
  // halves.
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
    for (auto& [edge, between] : cut_)
      done_.cut_edges.push_back({edge.first, edge.second, std::move(between)});
  }

  std::span<const double> coordinates_;
  const Loops& loops_;
  EdgeFaces edges_;
  // Of every face its loop in changed_, empty if it is gone, or -1 where it is as it was. Faces that
  // have come are numbered on from the others.
  std::vector<Index> changed_at_;
  std::vector<Loop> changed_;
  std::vector<Index> new_origin_;
  std::set<Waiting> waiting_;
  std::map<std::pair<Index, Index>, std::vector<Index>> cut_;
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
