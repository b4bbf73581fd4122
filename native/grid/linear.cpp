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

void refine_outside_linearly(const GridLevel& grid, std::span<const Vec3> control, double* x) {
  const ControlMesh& mesh = grid.mesh();
  if (mesh.region.whole()) return;
  for_each_run(grid, [&](const Run& run) {
    if (run.kind != RunKind::vertex && part_of_region(mesh, run) != RegionPart::inside)
      refine_run(grid, control, run, x);
  });
}

}  // namespace fairing
