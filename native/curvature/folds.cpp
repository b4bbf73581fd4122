// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/folds.h"

#include <Eigen/Geometry>

#include "grid/accumulate.h"
#include "grid/linear.h"
#include "grid/ring.h"
#include "grid/turns.h"

namespace fairing {
namespace {

// The definition of a fold: in any or in every way to cut the quads, and the cosine of the turn
// from which an edge counts as folded.
enum class Ways { any, every };
struct Cut {
  Ways ways = Ways::any;
  double cosine = 0;

  bool any() const { return ways == Ways::any; }
};

using Point = Eigen::Map<const Vec3>;

// Whether the edge between the triangles p q r and q p s is folded.
bool is_folded(const Cut& cut, const Point& p, const Point& q, const Point& r, const Point& s) {
  const Vec3 along = q - p;
  const Vec3 left = along.cross(r - p), right = (s - p).cross(along);
  const double least = cut.cosine == 0 ? 0 : cut.cosine * left.norm() * right.norm();
  return left.dot(right) < least;
}

// The possible third corners of triangles on one side of an edge; a quad has two.
struct Corners {
  const double* at[2];
  int count;
};

bool is_folded(const Cut& cut, const double* p, const double* q, const Corners& left,
               const Corners& right) {
  int folded = 0;
  for (int l = 0; l < left.count; ++l)
    for (int r = 0; r < right.count; ++r)
      folded += is_folded(cut, Point(p), Point(q), Point(left.at[l]), Point(right.at[r]));
  return cut.any() ? folded > 0 : folded == left.count * right.count;
}

// Calls visit(a, b) for every folded edge inside a face; a and b are closed coordinates.
template <class Visit>
void visit_in_face(Cut cut, bool quad, int n, const double* closed, Visit&& visit) {
  const auto at = [&](GridPoint p) {
    return closed + 3 * (closed_row(quad, std::size_t(n), std::size_t(p.j)) + std::size_t(p.i));
  };
  for_lines_in_face(quad, n, [&](GridPoint a, GridPoint b, GridPoint left, GridPoint right) {
    const auto beside = [&](GridPoint p) {
      if (!quad) return Corners{{at(p)}, 1};
      return Corners{{at(p), at({p.i + b.i - a.i, p.j + b.j - a.j})}, 2};
    };
    if (is_folded(cut, at(a), at(b), beside(left), beside(right))) visit(a, b);
  });
  if (!quad) return;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const GridPoint a{i, j}, b{i + 1, j}, c{i + 1, j + 1}, d{i, j + 1};
      const auto folded = [&](GridPoint from, GridPoint to, GridPoint left, GridPoint right) {
        return is_folded(cut, Point(at(from)), Point(at(to)), Point(at(left)), Point(at(right)));
      };
      const bool other = folded(b, d, a, c);
      if ((cut.any() || other) && folded(a, c, d, b)) visit(a, c);
      if (cut.any() && other) visit(b, d);
    }
}

// Calls visit(k) for every folded piece from k to k + 1 of a control edge.
template <class Visit>
void visit_on_edge(Cut cut, const GridLevel& grid, Index e, const double* x,
                   std::vector<double>& scratch, Visit&& visit) {
  const ControlMesh& mesh = grid.mesh();
  const EdgeLanes<double> lanes(grid, x, e, scratch);
  const auto beside = [&](std::size_t h, int k) {
    const double* row = lanes.lane[1 + h] + 3 * k;
    return Corners{{row, row + 3}, mesh.faces[mesh.face_beside(e, h)].quad() ? 2 : 1};
  };
  for (int k = 0; k < grid.n(); ++k)
    if (is_folded(cut, lanes.lane[0] + 3 * k, lanes.lane[0] + 3 * (k + 1), beside(0, k),
                  beside(1, k)))
      visit(k);
}

Folds find_folds(Cut cut, const GridLevel& grid, Workers& workers, const double* x,
                 const std::vector<std::uint8_t>& excused) {
  const ControlMesh& mesh = grid.mesh();
  const int n = grid.n();
  Folds folds;
  folds.in_face.assign(mesh.faces.size(), 0);
  folds.on_edge.assign(mesh.edges.size(), 0);
  const auto is_excused = [&](Index f) { return !excused.empty() && excused[f]; };
  for_face_parts(grid, workers, [&](Index begin, Index end) {
    std::vector<double> closed(3 * closed_size(true, std::size_t(n)));
    for (Index f = begin; f < end; ++f) {
      if (is_excused(f) || mesh.face_part(f) != RegionPart::inside) continue;
      gather_face(grid, x, f, closed.data());
      visit_in_face(cut, mesh.faces[f].quad(), n, closed.data(),
                    [&](GridPoint, GridPoint) { ++folds.in_face[f]; });
    }
  });
  for_edge_parts(grid, workers, [&](Index begin, Index end) {
    std::vector<double> scratch;
    for (Index e = begin; e < end; ++e) {
      if (!is_joined(mesh, e) || is_excused(mesh.face_beside(e, 0)) ||
          is_excused(mesh.face_beside(e, 1)))
        continue;
      visit_on_edge(cut, grid, e, x, scratch, [&](int) { ++folds.on_edge[e]; });
    }
  });
  return folds;
}

}  // namespace

std::size_t Folds::count() const {
  std::size_t total = 0;
  for (const std::uint32_t c : in_face) total += c;
  for (const std::uint32_t c : on_edge) total += c;
  return total;
}

Folds find_folds(const GridLevel& grid, Workers& workers, const double* x,
                 const std::vector<std::uint8_t>& excused) {
  return find_folds(Cut{}, grid, workers, x, excused);
}

std::vector<std::uint8_t> folded_control_faces(const ControlMesh& mesh,
                                               std::span<const Vec3> control, Workers& workers,
                                               double cosine) {
  const GridLevel grid(mesh, 0);
  std::vector<double> x(3 * grid.size());
  refine_linearly(grid, control, workers, x.data());
  const Folds folds = find_folds({Ways::every, cosine}, grid, workers, x.data(), {});
  std::vector<std::uint8_t> folded(mesh.faces.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) folded[f] = folds.in_face[f] > 0;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    for (std::size_t h = 0; h < 2 && folds.on_edge[e] > 0; ++h)
      folded[mesh.face_beside(Index(e), h)] = 1;
  return folded;
}

void mark_folds(const GridLevel& grid, const double* x, const Folds& folds, Array<float>& marks) {
  const ControlMesh& mesh = grid.mesh();
  const int n = grid.n();
  marks.assign(grid.size(), 0.0f);
  std::vector<double> scratch(3 * closed_size(true, std::size_t(n)));
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    if (!folds.in_face[f]) continue;
    gather_face(grid, x, f, scratch.data());
    visit_in_face(Cut{}, mesh.faces[f].quad(), n, scratch.data(), [&](GridPoint a, GridPoint b) {
      marks[grid.face_point(f, a)] = marks[grid.face_point(f, b)] = 1;
    });
  }
  for (Index e = 0; e < Index(mesh.edges.size()); ++e)
    if (folds.on_edge[e])
      visit_on_edge(Cut{}, grid, e, x, scratch, [&](int k) {
        marks[grid.edge_point(e, k)] = marks[grid.edge_point(e, k + 1)] = 1;
      });
}

}  // namespace fairing
