// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/linear.h"

#include "base/points.h"
#include "grid/runs.h"

namespace fairing {
namespace {

void refine_run(const GridLevel& grid, std::span<const Vec3> control, const Run& run, double* x) {
  const ControlMesh& mesh = grid.mesh();
  const int n = grid.n(), j = run.row, count = int(run.count);
  x += 3 * run.first;
  if (run.kind == RunKind::vertex) {
    put_point(control[run.first], x);
    return;
  }
  if (run.kind == RunKind::edge) {
    const Edge& edge = mesh.edges[run.element];
    const Vec3 &a = control[edge.vertex[0]], &b = control[edge.vertex[1]];
    for (int k = 1; k <= count; ++k) x = put_point((double(n - k) * a + double(k) * b) / n, x);
    return;
  }
  const Face& face = mesh.faces[run.element];
  const auto corner = [&](std::size_t c) -> const Vec3& { return control[face.vertex[c]]; };
  if (run.quad) {
    const Vec3 left = (double(n - j) * corner(0) + double(j) * corner(3)) / n,
               right = (double(n - j) * corner(1) + double(j) * corner(2)) / n;
    for (int i = 1; i <= count; ++i)
      x = put_point((double(n - i) * left + double(i) * right) / n, x);
    return;
  }
  for (int i = 1; i <= count; ++i)
    x = put_point(
        (double(n - i - j) * corner(0) + double(i) * corner(1) + double(j) * corner(2)) / n, x);
}

}  // namespace

void refine_linearly(const GridLevel& grid, std::span<const Vec3> control, Workers& workers,
                     double* x) {
  for_each_run(grid, workers, [&](const Run& run) { refine_run(grid, control, run, x); });
}

namespace {

// How far a curve on a side of a face leaves the side, at point k of n; corners: not at all.
class Bulge {
 public:
  Bulge(const GridLevel& grid, std::span<const Vec3> control, std::span<const Index> curve,
        const double* x)
      : grid_(grid), control_(control), curve_(curve), x_(x) {}

  bool any(const Face& face) const {
    for (int s = 0; s < face.size; ++s)
      if (curve_[side(face, s).edge] >= 0) return true;
    return false;
  }
  Vec3 operator()(const Face& face, int s, int k) const {
    const Side& at = side(face, s);
    const int n = grid_.n();
    if (curve_[at.edge] < 0 || k <= 0 || k >= n) return Vec3::Zero();
    if (at.reversed) k = n - k;
    const auto& ends = grid_.mesh().edges[at.edge].vertex;
    const Vec3 chord = (double(n - k) * control_[ends[0]] + double(k) * control_[ends[1]]) / n;
    return point_at(x_, grid_.edge_point(at.edge, k)) - chord;
  }

 private:
  const Side& side(const Face& face, int s) const {
    return grid_.mesh().sides[std::size_t(face.first_side + s)];
  }
  const GridLevel& grid_;
  std::span<const Vec3> control_;
  std::span<const Index> curve_;
  const double* x_;
};

void add(const Vec3& by, double* x) {
  for (int a = 0; a < 3; ++a) x[a] += by[a];
}

// Adds the bulges of a face's sides: on quads those of a patch of Coons [1967], on triangles such that
// a triangle of a disc keeps its shape towards the centre.
void bulge_run(const Bulge& bulge, const Face& face, int n, const Run& run, double* x) {
  const int j = run.row;
  x += 3 * run.first;
  for (int i = 1; i <= int(run.count); ++i, x += 3) {
    if (run.quad) {
      add((double(n - j) * bulge(face, 0, i) + double(i) * bulge(face, 1, j) +
           double(j) * bulge(face, 2, n - i) + double(n - i) * bulge(face, 3, n - j)) /
              n,
          x);
      continue;
    }
    const int weight[3] = {n - i - j, i, j};
    for (int s = 0; s < 3; ++s) {
      const int a = weight[s], b = weight[(s + 1) % 3], c = weight[(s + 2) % 3];
      add((double(a) * bulge(face, s, b) + double(b) * bulge(face, s, b + c)) * n /
              (double(a + b) * (n + c)),
          x);
    }
  }
}

}  // namespace

void refine_outside(const GridLevel& grid, std::span<const Vec3> control,
                    std::span<const Index> curve, double* x) {
  const ControlMesh& mesh = grid.mesh();
  if (mesh.region.whole()) return;
  const Bulge bulge(grid, control, curve, x);
  for_each_run(grid, [&](const Run& run) {
    if (run.kind == RunKind::vertex || part_of_region(mesh, run) == RegionPart::inside) return;
    if (run.kind == RunKind::edge && curve[run.element] >= 0) return;
    refine_run(grid, control, run, x);
    if (run.kind == RunKind::face_row && bulge.any(mesh.faces[run.element]))
      bulge_run(bulge, mesh.faces[run.element], grid.n(), run, x);
  });
}

}  // namespace fairing
