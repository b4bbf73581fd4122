// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/feet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/points.h"
#include "fit/point_tree.h"
#include "grid/runs.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Weights of a triangle's corners at its nearest point to p [Ericson 2005, 5.1.5].
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d3 / (d3 - d1), d1 / (d1 - d3), 0};
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {d6 / (d6 - d2), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4, along = d4 - d3, back = d5 - d6;
  if (va <= 0 && along >= 0 && back >= 0) return {0, back / (along + back), along / (along + back)};
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

// The corner of its cell that is nearest to a foot.
std::size_t nearest_corner(const CornerShares& shares) {
  return std::size_t(std::max_element(shares.begin(), shares.end()) - shares.begin());
}

// The nearest of the points that count; at equal distance the one with the smaller number.
template <class Counts>
class NearestThatCounts {
 public:
  using DistanceType = double;
  using IndexType = Index;
  NearestThatCounts(const Counts& counts, double most) : counts_(counts), square_(most * most) {}
  bool addPoint(double square, Index p) {
    if ((square < square_ || (square == square_ && p < point_)) && counts_(p)) {
      square_ = square;
      point_ = p;
    }
    return true;
  }
  double worstDist() const { return square_; }
  std::size_t size() const { return point_ >= 0; }
  bool full() const { return point_ >= 0; }
  void sort() {}
  Index point() const { return point_; }

 private:
  const Counts& counts_;
  double square_;
  Index point_ = -1;
};

}  // namespace

FeetFinder::FeetFinder(const Cells& cells, const Scan& scan, double reach, Workers& workers)
    : cells_(cells), scan_(scan), reach_(reach), workers_(workers) {
  const GridLevel& grid = cells.grid();
  const ControlMesh& mesh = grid.mesh();
  on_curve_.assign(grid.size(), 0);
  on_border_.assign(grid.size(), 0);
  for (std::size_t v = 0; v < mesh.feature_vertex.size(); ++v)
    on_curve_[v] = mesh.feature_vertex[v];
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    for (int k = 0; k <= grid.n(); ++k) {
      const auto p = std::size_t(grid.edge_point(Index(e), k));
      on_curve_[p] |= mesh.feature_edge[e];
      on_border_[p] |= mesh.edges[e].boundary();
    }
}

void FeetFinder::set_surface(const double* x) {
  x_ = x;
  cell_normal_.resize(cells_.size());
  point_normal_.resize(cells_.grid().size());
  workers_.for_each(cells_.size(), vertex_grain, [&](std::size_t c) {
    const auto& corner = cells_.corners(Index(c));
    cell_normal_[c] = corner[3] >= 0
                          ? (at(corner[2]) - at(corner[0])).cross(at(corner[3]) - at(corner[1]))
                          : (at(corner[1]) - at(corner[0])).cross(at(corner[2]) - at(corner[0]));
  });
  workers_.for_each(point_normal_.size(), vertex_grain, [&](std::size_t p) {
    Vec3 sum = Vec3::Zero();
    if (!on_curve_[p])
      for (const auto& [cell, corner] : cells_.at_point(Index(p))) sum += cell_normal_[cell];
    point_normal_[p] = unit_or_zero(sum);
  });
  workers_.for_each(cells_.size(), vertex_grain,
                    [&](std::size_t c) { cell_normal_[c] = unit_or_zero(cell_normal_[c]); });
}

Vec3 FeetFinder::point_at_foot(const Foot& foot, const std::array<Vec3, 4>& normals) const {
  const auto& corner = cells_.corners(foot.cell);
  Vec3 flat = Vec3::Zero(), above = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k)
    if (corner[k] >= 0) flat += double(foot.shares[k]) * at(corner[k]);
  for (std::size_t k = 0; k < 4; ++k)
    if (corner[k] >= 0)
      above += double(foot.shares[k]) * (at(corner[k]) - flat).dot(normals[k]) * normals[k];
  return flat + above / 2;
}

std::array<Vec3, 4> FeetFinder::corner_normals(Index cell) const {
  const auto& corner = cells_.corners(cell);
  std::array<Vec3, 4> out;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto p = std::size_t(std::max(corner[k], 0));
    out[k] = on_curve_[p] ? cell_normal_[cell] : point_normal_[p];
  }
  return out;
}

Vec3 FeetFinder::normal_at(const Foot& foot, const std::array<Vec3, 4>& corners) {
  Vec3 sum = Vec3::Zero();  // a triangle's fourth corner has weight zero
  for (std::size_t k = 0; k < 4; ++k) sum += double(foot.shares[k]) * corners[k];
  return unit_or_zero(sum);
}

// A quad is four triangles around its centre, so that no diagonal is preferred.
FeetFinder::Nearest FeetFinder::nearest_on(Index cell, const Vec3& point) const {
  const auto& corner = cells_.corners(cell);
  if (corner[3] < 0) {
    const Vec3 a = at(corner[0]), b = at(corner[1]), c = at(corner[2]);
    const Vec3 share = nearest_on_triangle(point, a, b, c);
    return {{float(share[0]), float(share[1]), float(share[2]), 0},
            (share[0] * a + share[1] * b + share[2] * c - point).squaredNorm()};
  }
  const Vec3 p[4] = {at(corner[0]), at(corner[1]), at(corner[2]), at(corner[3])};
  const Vec3 middle = 0.25 * (p[0] + p[1] + p[2] + p[3]);
  Nearest best{{}, std::numeric_limits<double>::max()};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    const Vec3 share = nearest_on_triangle(point, p[k], p[next], middle);
    const double square =
        (share[0] * p[k] + share[1] * p[next] + share[2] * middle - point).squaredNorm();
    if (!(square < best.square)) continue;
    best.square = square;
    best.shares.fill(float(0.25 * share[2]));
    best.shares[k] += float(share[0]);
    best.shares[next] += float(share[1]);
  }
  return best;
}

bool FeetFinder::agrees(Index cell, std::size_t point) const {
  return scan_.normal.empty() || scan_.normal[point].cast<double>().dot(cell_normal_[cell]) >= 0;
}

// Starts at a point of the surface and a foot at this squared distance, and descends to nearer feet
// on the cells around. Returns whether there was a nearer one.
bool FeetFinder::descend(std::size_t point, Index start, Foot& foot, double square) const {
  bool any = false;
  for (;;) {  // ends, since distances decrease
    bool nearer = false;
    for (const auto& [cell, corner] : cells_.at_point(start)) {
      if (!agrees(cell, point)) continue;
      const Nearest nearest = nearest_on(cell, scan_.point[point]);
      if (!(nearest.square < square)) continue;
      square = nearest.square;
      foot.cell = cell;
      foot.shares = nearest.shares;
      nearer = any = true;
    }
    if (!nearer) break;
    const auto& corner = cells_.corners(foot.cell);
    const Index next = corner[nearest_corner(foot.shares)];
    if (next == start) break;
    start = next;
  }
  return any;
}

bool FeetFinder::is_on_border(const Foot& foot) const {
  const auto& corner = cells_.corners(foot.cell);
  for (std::size_t k = 0; k < 4; ++k)
    if (corner[k] >= 0 && foot.shares[k] > 0 && !on_border_[corner[k]]) return false;
  return true;
}

void FeetFinder::finish(std::size_t point, Foot& foot) const {
  if (foot.cell < 0) return;
  const std::array<Vec3, 4> normals = corner_normals(foot.cell);
  foot.offset =
      float((scan_.point[point] - point_at_foot(foot, normals)).dot(normal_at(foot, normals)));
  foot.outside = is_on_border(foot);
}

void FeetFinder::find(Array<Foot>& feet, bool any_side) const {
  feet.assign(scan_.size(), {});
  search(feet, any_side, 0);
}

void FeetFinder::find_beyond(double distance, Array<Foot>& feet) const {
  search(feet, false, distance);
}

void FeetFinder::search(Array<Foot>& feet, bool any_side, double beyond) const {
  const PointsOfTree surface{x_, cells_.grid().size()};
  const PointTree tree(3, surface);
  const auto nearest_to = [&](std::size_t s, const auto& counts, double most) {
    NearestThatCounts nearest(counts, most);
    tree.findNeighbors(nearest, scan_.point[s].data(), {});
    return nearest.point();
  };
  const auto is_used = [&](Index p) { return !cells_.at_point(p).empty(); };
  workers_.for_each(scan_.size(), vertex_grain, [&](std::size_t s) {
    Foot& foot = feet[s];
    if (foot.cell >= 0 && std::abs(distance(s, foot)) <= beyond) return;
    foot = {};
    Index nearest = nearest_to(s, is_used, std::numeric_limits<float>::max());
    const auto agrees_at = [&](Index p) {
      for (const auto& [cell, corner] : cells_.at_point(p))
        if (agrees(cell, s)) return true;
      return false;
    };
    // the search has a bound: for a scan that is inside out it would visit the whole surface
    if (nearest >= 0 && !any_side && !agrees_at(nearest))
      nearest = nearest_to(s, agrees_at, (scan_.point[s] - at(nearest)).norm() + reach_);
    if (nearest < 0) return;
    if (any_side) {
      foot.cell = cells_.at_point(nearest)[0].cell;
      foot.shares = nearest_on(foot.cell, scan_.point[s]).shares;
    } else {
      descend(s, nearest, foot, std::numeric_limits<double>::max());
    }
    finish(s, foot);
  });
}

void FeetFinder::follow(Array<Foot>& feet) const {
  workers_.for_each(feet.size(), vertex_grain, [&](std::size_t s) {
    Foot& foot = feet[s];
    if (foot.cell < 0) return;
    const Nearest here = nearest_on(foot.cell, scan_.point[s]);
    foot.shares = here.shares;
    // a foot inside its cell is the nearest; otherwise adjacent cells are tried
    const bool inside =
        std::all_of(foot.shares.begin(), foot.shares.begin() + (cells_.quad(foot.cell) ? 4 : 3),
                    [](float share) { return share > 0; });
    if (!inside) {
      descend(s, cells_.corners(foot.cell)[nearest_corner(foot.shares)], foot, here.square);
    }
    finish(s, foot);
  });
}

void FeetFinder::measure(Array<Foot>& feet) const {
  workers_.for_each(feet.size(), vertex_grain, [&](std::size_t s) { finish(s, feet[s]); });
}

}  // namespace fairing
