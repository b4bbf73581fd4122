// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fill/refine.h"

#include <Eigen/Geometry>
#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/points.h"
#include "base/roundoff.h"
#include "mesh/sharp_turn.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

using Mesh = OpenMesh::TriConnectivity;
using Half = OpenMesh::HalfedgeHandle;
using EdgeHandle = OpenMesh::EdgeHandle;
using VertexHandle = OpenMesh::VertexHandle;

// An edge is split or collapsed if its length becomes closer to the requested one: halves of 4/3
// are as far from 1 as 4/3 is, and so is an edge of 4/5 after it becomes half as long again.
constexpr double too_long = 4.0 / 3.0, too_short = 4.0 / 5.0;

// Far inside, edges are as long as this share of the distance from the rim: a wide hole needs few
// triangles.
constexpr double grown_edge = 0.08;

// Rounds of splits with sweeps of relaxation: angles change no more after about ten rounds, of
// which the first find the number of points to one per cent.
constexpr int most_refinements = 40, settled_rounds = 6, sweeps = 4;

class Refinement {
 public:
  Refinement(Patch& patch, const std::function<bool(Index, Index)>& joined, Relaxation relaxation)
      : patch_(patch), joined_(joined), relaxation_(relaxation) {
    mesh_.request_vertex_status();
    mesh_.request_halfedge_status();
    mesh_.request_edge_status();
    mesh_.request_face_status();
    for (std::size_t v = 0; v < patch.points.size(); ++v) mesh_.add_vertex();
    for (const Triangle& t : patch.triangles) {
      const VertexHandle corners[3] = {VertexHandle(t[0]), VertexHandle(t[1]), VertexHandle(t[2])};
      if (!mesh_.add_face(corners, 3).is_valid())
        throw FairingError(ErrorCode::nonmanifold_vertex,
                           "The rim of the hole touches itself in a way that no surface fills.");
    }
  }

  void run() {
    flip_all();
    int settled = 0;
    for (int round = 0; round < most_refinements && settled < settled_rounds; ++round) {
      find_depths();
      const std::size_t split = split_all(), collapsed = collapse_all();
      flip_all();
      const std::size_t one_percent = mesh_.n_edges() / 100;
      settled += split + collapsed <= one_percent;
      for (int sweep = 0; sweep < sweeps; ++sweep) {
        relax();
        flip_all();
      }
    }
    write();
  }

 private:
  const Vec3& point(VertexHandle v) const { return patch_.points[v.idx()]; }
  double wanted(VertexHandle v) const {
    return std::hypot(patch_.lengths[v.idx()], grown_edge * depths_[v.idx()]);
  }
  VertexHandle from(Half h) const { return mesh_.from_vertex_handle(h); }
  VertexHandle to(Half h) const { return mesh_.to_vertex_handle(h); }
  bool on_rim(VertexHandle v) const { return v.idx() < patch_.rim; }
  bool is_gone(EdgeHandle e) const { return mesh_.status(e).deleted(); }
  VertexHandle opposite(Half h) const { return to(mesh_.next_halfedge_handle(h)); }

  // Calls visit(h) for the half-edges that leave a vertex, in the direction of its triangles.
  template <class Visit>
  void visit_spokes(VertexHandle v, const Visit& visit) const {
    const Half first = mesh_.halfedge_handle(v);
    Half h = first;
    do {
      visit(h);
      h = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(h));
    } while (h != first);
  }

  // The distance of each point from the rim along edges.
  void find_depths() {
    depths_.assign(patch_.points.size(), std::numeric_limits<double>::infinity());
    std::fill_n(depths_.begin(), patch_.rim, 0.0);
    for (bool changed = true; changed;) {
      changed = false;
      for (int e = 0; e < int(mesh_.n_edges()); ++e) {
        if (is_gone(EdgeHandle(e))) continue;
        const Half h = mesh_.halfedge_handle(EdgeHandle(e), 0);
        double &a = depths_[from(h).idx()], &b = depths_[to(h).idx()];
        const double length = (point(to(h)) - point(from(h))).norm();
        changed = changed || a > b + length || b > a + length;
        a = std::min(a, b + length), b = std::min(b, a + length);
      }
    }
  }

  // Length relative to the requested one.
  double relative_length(EdgeHandle e) {
    const Half h = mesh_.halfedge_handle(e, 0);
    return (point(to(h)) - point(from(h))).norm() * 2 / (wanted(to(h)) + wanted(from(h)));
  }

  Vec3 area(VertexHandle a, VertexHandle b, VertexHandle c) const {
    return (point(b) - point(a)).cross(point(c) - point(a));
  }

  // Cosine of the smallest angle of a triangle: large is bad; 2 without area.
  double badness(VertexHandle a, VertexHandle b, VertexHandle c) const {
    const Vec3 sides[3] = {point(b) - point(a), point(c) - point(b), point(a) - point(c)};
    double worst = -1;
    for (int i = 0; i < 3; ++i) {
      const Vec3 &leaving = sides[i], &arriving = sides[(i + 2) % 3];
      const double lengths = leaving.norm() * arriving.norm();
      if (lengths <= 0) return 2;
      worst = std::max(worst, -leaving.dot(arriving) / lengths);
    }
    return worst;
  }

  std::size_t split_all() {
    std::vector<std::pair<double, int>> longest;
    for (int e = 0; e < int(mesh_.n_edges()); ++e) {
      const EdgeHandle edge(e);
      if (is_gone(edge) || mesh_.is_boundary(edge)) continue;
      const double length = relative_length(edge);
      if (length > too_long) longest.push_back({-length, e});
    }
    std::sort(longest.begin(), longest.end());
    if (patch_.points.size() + longest.size() > largest_filling) too_dense();
    for (std::size_t i = 0; i < longest.size(); ++i) {
      stop_if_cancelled(i);
      split(EdgeHandle(longest[i].second));
    }
    return longest.size();
  }

  void split(EdgeHandle e) {
    const Half h = mesh_.halfedge_handle(e, 0);
    const VertexHandle a = from(h), b = to(h);
    const Vec3 middle = (point(a) + point(b)) / 2 + bulge(a, b);
    const double length = (patch_.lengths[a.idx()] + patch_.lengths[b.idx()]) / 2;
    depths_.push_back((depths_[a.idx()] + depths_[b.idx()]) / 2);
    patch_.points.push_back(middle);
    patch_.lengths.push_back(length);
    mesh_.split(e, mesh_.add_vertex());
  }

  // Offset from the chord at the midpoint of a cubic arc between two points, perpendicular to their
  // normals: otherwise the bend of the surface would concentrate at the edges that were split. Zero
  // if the normals are unreliable.
  Vec3 bulge(VertexHandle a, VertexHandle b) {
    if (relaxation_ != Relaxation::curved) return Vec3::Zero();
    const Vec3 chord = point(b) - point(a), at_a = normal(a), at_b = normal(b);
    if (at_a.dot(at_b) < sharp_turn) return Vec3::Zero();
    return (chord.dot(at_b) * at_b - chord.dot(at_a) * at_a) / 8;
  }

  // Unit normal: the mean of the triangles around and of the faces behind the rim.
  Vec3 normal(VertexHandle v) const {
    Vec3 sum = Vec3::Zero();
    visit_spokes(v, [&](Half h) {
      if (!mesh_.is_boundary(h)) sum += unit_or_zero(area(from(h), to(h), opposite(h)));
    });
    if (on_rim(v) && !patch_.rim_normals.empty()) sum += patch_.rim_normals[v.idx()];
    return unit_or_zero(sum);
  }

  std::size_t collapse_all() {
    std::size_t count = 0;
    for (int e = 0; e < int(mesh_.n_edges()); ++e) {
      stop_if_cancelled(std::size_t(e));
      const EdgeHandle edge(e);
      if (is_gone(edge) || mesh_.is_boundary(edge) || relative_length(edge) >= too_short) continue;
      for (const int side : {0, 1}) {
        const Half h = mesh_.halfedge_handle(edge, side);
        if (on_rim(from(h)) || !may_collapse(h)) continue;
        mesh_.collapse(h);
        ++count;
        break;
      }
    }
    return count;
  }

  // Whether from(h), an inner vertex, may move to to(h) without long edges or reversed triangles.
  bool may_collapse(Half h) {
    if (!mesh_.is_collapse_ok(h)) return false;
    const VertexHandle removed = from(h), kept = to(h);
    Half spoke = h;
    do {
      const VertexHandle other = to(spoke), next = opposite(spoke);
      if (other != kept && on_rim(other) && on_rim(kept) && joined_(other.idx(), kept.idx()))
        return false;
      const double length = (point(other) - point(kept)).norm();
      if (2 * length > too_long * (wanted(other) + wanted(kept))) return false;
      if (other != kept && next != kept) {
        const Vec3 before = area(removed, other, next), after = area(kept, other, next);
        if (before.dot(after) <= sharp_turn * before.norm() * after.norm()) return false;
        const Half far = mesh_.next_halfedge_handle(spoke);
        if (turn(far, unit_or_zero(after)) < std::min(turn(far, unit_or_zero(before)), sharp_turn))
          return false;
      }
      spoke = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(spoke));
    } while (spoke != h);
    return true;
  }

  // Until no flip increases the smallest angle of two triangles.
  void flip_all() {
    std::vector<int> open(mesh_.n_edges());
    for (std::size_t e = 0; e < open.size(); ++e) open[e] = int(e);
    while (!open.empty()) {  // ends, since each flip increases the smallest of their angles
      std::vector<int> next;
      for (std::size_t i = 0; i < open.size(); ++i) {
        stop_if_cancelled(i);
        const EdgeHandle edge(open[i]);
        if (!should_flip(edge)) continue;
        mesh_.flip(edge);
        for (const int side : {0, 1}) {
          const Half h = mesh_.halfedge_handle(edge, side);
          next.push_back(mesh_.next_halfedge_handle(h).idx() / 2);
          next.push_back(mesh_.prev_halfedge_handle(h).idx() / 2);
        }
      }
      std::sort(next.begin(), next.end());
      next.erase(std::unique(next.begin(), next.end()), next.end());
      open = std::move(next);
    }
  }

  bool should_flip(EdgeHandle e) {
    if (is_gone(e) || mesh_.is_boundary(e)) return false;
    const Half h = mesh_.halfedge_handle(e, 0), back = mesh_.halfedge_handle(e, 1);
    const VertexHandle a = from(h), b = to(h), c = opposite(h), d = opposite(back);
    if (on_rim(c) && on_rim(d) && joined_(c.idx(), d.idx())) return false;
    const double now = std::max(badness(a, b, c), badness(b, a, d));
    if (badness(c, d, b) >= now - roundoff || badness(d, c, a) >= now - roundoff) return false;
    if (!mesh_.is_flip_ok(e)) return false;
    // the sides b-c and a-d, c-a and d-b keep their neighbours
    const Half bc = mesh_.next_halfedge_handle(h), ca = mesh_.prev_halfedge_handle(h);
    const Half ad = mesh_.next_halfedge_handle(back), db = mesh_.prev_halfedge_handle(back);
    const Vec3 old[2] = {unit_or_zero(area(a, b, c)), unit_or_zero(area(b, a, d))};
    const Vec3 fresh[2] = {unit_or_zero(area(c, d, b)), unit_or_zero(area(d, c, a))};
    if (fresh[0].isZero() || fresh[1].isZero()) return false;
    const double before = sharpness(old[0].dot(old[1])) + sharpness(turn(bc, old[0])) +
                          sharpness(turn(ca, old[0])) + sharpness(turn(ad, old[1])) +
                          sharpness(turn(db, old[1]));
    const double after = sharpness(fresh[0].dot(fresh[1])) + sharpness(turn(bc, fresh[0])) +
                         sharpness(turn(db, fresh[0])) + sharpness(turn(ca, fresh[1])) +
                         sharpness(turn(ad, fresh[1]));
    return after <= before;
  }

  // Excess of a turn with this cosine over the limit for flips and moves; if some turns exceed it
  // already, their sum must not grow.
  static double sharpness(double cosine) { return std::max(0.0, sharp_turn - cosine); }

  // The normal of the neighbour across side h, or of the face behind the rim there, if known.
  std::optional<Vec3> normal_beyond(Half h) const {
    const Half back = mesh_.opposite_halfedge_handle(h);
    if (!mesh_.is_boundary(back)) return unit_or_zero(area(from(back), to(back), opposite(back)));
    if (patch_.rim_normals.empty()) return {};
    const Vec3& behind = patch_.rim_normals[from(h).idx()];
    return behind.isZero() ? std::optional<Vec3>() : behind;
  }

  // The cosine between a triangle's normal and that of the neighbour across side h; 1 without a
  // neighbour.
  static double turn(const std::optional<Vec3>& beyond, const Vec3& normal) {
    return beyond ? beyond->dot(normal) : 1;
  }
  double turn(Half h, const Vec3& normal) const { return turn(normal_beyond(h), normal); }

  void relax() {
    for (int v = patch_.rim; v < int(mesh_.n_vertices()); ++v) {
      stop_if_cancelled(std::size_t(v));
      const VertexHandle vertex(v);
      if (mesh_.status(vertex).deleted()) continue;
      find_ring(vertex);
      Vec3 mean = Vec3::Zero(), normal = Vec3::Zero();
      double length = 0;
      for (std::size_t i = 0; i < ring_.size(); ++i) {
        mean += point(to(ring_[i]));
        length += patch_.lengths[to(ring_[i]).idx()];
        normal += ring_area(i, point(vertex));
      }
      const auto count = double(ring_.size());
      Vec3 step = mean / count - point(vertex);
      if (relaxation_ != Relaxation::taut && normal.squaredNorm() > 0)
        step -= step.dot(normal) / normal.squaredNorm() * normal;
      move(vertex, step);
      patch_.lengths[vertex.idx()] = length / count;
    }
  }

  // The neighbours of an inner vertex, in the direction of its triangles, and what is beyond these.
  void find_ring(VertexHandle vertex) {
    ring_.clear();
    beyond_.clear();
    visit_spokes(vertex, [&](Half h) {
      ring_.push_back(h);
      beyond_.push_back(normal_beyond(mesh_.next_halfedge_handle(h)));
    });
  }

  // Area vector of the triangle of two neighbours and the vertex at `middle`.
  Vec3 ring_area(std::size_t i, const Vec3& middle) const {
    const Half far = mesh_.next_halfedge_handle(ring_[i]);
    return (point(from(far)) - middle).cross(point(to(far)) - middle);
  }

  // The sum of excess turns of the ring's triangles, with the vertex at `middle`, against their
  // mean and against their neighbours.
  double ring_sharpness(const Vec3& middle) {
    areas_.clear();
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      areas_.push_back(ring_area(i, middle));
      sum += areas_.back();
    }
    sum = unit_or_zero(sum);
    double total = 0;
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const Vec3 normal = unit_or_zero(areas_[i]);
      total +=
          sharpness(normal.isZero() ? -1 : normal.dot(sum)) + sharpness(turn(beyond_[i], normal));
    }
    return total;
  }

  // Moves as far along `step` as no triangle turns too far: next to a rim that bends inwards, the
  // mean of the neighbours may be beyond it.
  void move(VertexHandle vertex, const Vec3& step) {
    Vec3& place = patch_.points[vertex.idx()];
    const double before = ring_sharpness(place);
    for (const double share : {1.0, 0.5, 0.25})
      if (ring_sharpness(place + share * step) <= before) {
        place += share * step;
        return;
      }
  }

  void write() {
    std::vector<Index> number(mesh_.n_vertices(), -1);
    Index count = 0;
    for (int v = 0; v < int(mesh_.n_vertices()); ++v) {
      if (v >= patch_.rim && mesh_.status(VertexHandle(v)).deleted()) continue;
      number[v] = count;
      patch_.points[count] = patch_.points[v];
      patch_.lengths[count++] = patch_.lengths[v];
    }
    patch_.points.resize(std::size_t(count));
    patch_.lengths.resize(std::size_t(count));
    patch_.triangles.clear();
    for (int f = 0; f < int(mesh_.n_faces()); ++f) {
      const OpenMesh::FaceHandle face(f);
      if (mesh_.status(face).deleted()) continue;
      const Half h = mesh_.halfedge_handle(face);
      patch_.triangles.push_back(
          {number[from(h).idx()], number[to(h).idx()], number[opposite(h).idx()]});
    }
  }

  Patch& patch_;
  const std::function<bool(Index, Index)>& joined_;
  Relaxation relaxation_;
  std::vector<double> depths_;
  Mesh mesh_;
  std::vector<Half> ring_;
  std::vector<std::optional<Vec3>> beyond_;
  std::vector<Vec3> areas_;
};

}  // namespace

void too_dense() {
  throw FairingError(
      ErrorCode::too_large,
      {"The filling would have more than a hundred million vertices.", "Lower the density."});
}

void refine(Patch& patch, const std::function<bool(Index, Index)>& joined, Relaxation relaxation) {
  Refinement(patch, joined, relaxation).run();
}

}  // namespace fairing
