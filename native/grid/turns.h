// SPDX-License-Identifier: GPL-3.0-or-later
// Lines between the cells of a level, and how sharply a surface turns across them.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "grid/grid_level.h"
#include "parallel/workers.h"

namespace fairing {

// Calls visit(a, b, left, right) for every line from a to b between two cells inside a face, in
// closed coordinates. `left` and `right` are the cells' third corners in a triangle; in a quad
// those next to a, and b has such neighbours too.
template <class Visit>
void for_lines_in_face(bool quad, int n, Visit&& visit) {
  if (!quad) {  // every line belongs to one triangle that points down
    for (int j = 0; j + 1 < n; ++j)
      for (int i = 0; i + j + 1 < n; ++i) {
        const GridPoint a{i + 1, j}, b{i + 1, j + 1}, c{i, j + 1};
        visit(a, b, c, GridPoint{i + 2, j});
        visit(b, c, a, GridPoint{i, j + 2});
        visit(c, a, b, GridPoint{i, j});
      }
    return;
  }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const GridPoint a{i, j}, b{i + 1, j}, d{i, j + 1};
      if (j > 0) visit(a, b, d, GridPoint{i, j - 1});
      if (i > 0) visit(a, d, GridPoint{i - 1, j}, b);
    }
}

// Whether the surface is one across a control edge, inside the region.
inline bool is_joined(const ControlMesh& mesh, Index e) {
  return !mesh.edges[e].boundary() && !mesh.feature_edge[e] &&
         mesh.edge_part(e) != RegionPart::outside;
}

// A cell of a surface: a normal of any length, and the largest extent.
struct CellPlane {
  Vec3 normal;
  double extent;
};

// On the left of the line from a to b: a triangle with a third corner; a quad with corners next to
// a and next to b, by its diagonals.
inline CellPlane left_cell(const Vec3& a, const Vec3& b, const Vec3& third) {
  return {(b - a).cross(third - a),
          std::sqrt(std::max(
              {(b - a).squaredNorm(), (third - b).squaredNorm(), (a - third).squaredNorm()}))};
}
inline CellPlane left_cell(const Vec3& a, const Vec3& b, const Vec3& next_to_a,
                           const Vec3& next_to_b) {
  const Vec3 one = next_to_b - a, other = next_to_a - b;
  return {one.cross(other), std::sqrt(std::max(one.squaredNorm(), other.squaredNorm()))};
}

// The largest angle between normals of cells, without turns whose height is less than `least`.
class SharpestTurn {
 public:
  explicit SharpestTurn(double least) : least_(least) {}
  // A surface that rounds the line off passes it at half the height of the smaller cell.
  void between(const CellPlane& a, const CellPlane& b) {
    const double angle = angle_between(a.normal, b.normal);
    const double height = std::min(a.extent, b.extent) * std::sin(angle / 2) / 2;
    if (height >= least_) angle_ = std::max(angle_, angle);
  }
  double angle() const { return angle_; }

 private:
  double least_, angle_ = 0;
};

// The same across all lines inside a face that count(a, b). at(point) is its place.
template <class At, class Counts>
double turn_in_face(bool quad, int n, double least, At&& at, Counts&& counts) {
  SharpestTurn turn(least);
  for_lines_in_face(quad, n, [&](GridPoint a, GridPoint b, GridPoint left, GridPoint right) {
    if (!counts(a, b)) return;
    const Vec3 from = at(a), to = at(b);
    if (!quad) {
      turn.between(left_cell(from, to, at(left)), left_cell(to, from, at(right)));
      return;
    }
    const auto next = [&](GridPoint p) { return at(GridPoint{p.i + b.i - a.i, p.j + b.j - a.j}); };
    turn.between(left_cell(from, to, at(left), next(left)),
                 left_cell(to, from, next(right), at(right)));
  });
  return turn.angle();
}

// For each control face the sharpest turn of the surface x (3 numbers a point) from one of its
// cells to the next, in radians. Borders, creases and what is outside the region do not count.
std::vector<double> sharpest_turns(const GridLevel& grid, Workers& workers, const double* x);

}  // namespace fairing
