// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/weights.h"

#include <algorithm>
#include <cmath>

namespace fairing {

bool EnergyWeight::joint_weighs_edge(Index e) const {
  if (!fades()) return any() && clamped_edge(e);
  return clamped_vertex(edge(e).vertex[0]) || clamped_vertex(edge(e).vertex[1]);
}

bool EnergyWeight::joint_weighs_face(Index f) const {
  if (!fades()) return false;
  const Face& face = mesh_.faces[f];
  for (int c = 0; c < face.size; ++c)
    if (clamped_vertex(face.vertex[c])) return true;
  return false;
}

bool EnergyWeight::weighs(const Run& run) const {
  switch (run.kind) {
    case RunKind::vertex:
      return (any() && clamped_vertex(run.element)) || stiffness_.weighs_vertex(run.element);
    case RunKind::edge: return weighs_edge(run.element);
    default: return weighs_face(run.element);
  }
}

double EnergyWeight::beside_joint(Index e, int k) const {
  if (!any()) return 1;
  if (clamped_edge(e)) return on_joint();
  if (!fades()) return 1;
  int steps = n_;
  if (clamped_vertex(edge(e).vertex[0])) steps = std::min(steps, k);
  if (clamped_vertex(edge(e).vertex[1])) steps = std::min(steps, n_ - k);
  return off_joint(steps);
}

double EnergyWeight::beside_joint(Index f, int i, int j) const {
  if (!fades()) return 1;
  const Face& face = mesh_.faces[f];
  double steps = n_;
  for_distances(face, n_, i, j, [&](std::size_t s, double row, double, double corner) {
    if (clamped_edge(mesh_.sides[std::size_t(face.first_side) + s].edge))
      steps = std::min(steps, row);
    if (clamped_vertex(face.vertex[s])) steps = std::min(steps, corner);
  });
  return off_joint(std::max(steps, 1.0));  // only points inside the face count
}

namespace {

// For points of the runs that `factor` weights.
template <class Number>
Array<double> of_points(const GridLevel& grid, const EnergyWeight& factor, Number&& number) {
  Array<double> out(grid.size(), 1.0);
  for_each_run(grid, [&](const Run& run) {
    if (!factor.weighs(run)) return;
    for (std::size_t i = 0; i < run.count; ++i) out[run.first + i] = number(run, i);
  });
  return out;
}

}  // namespace

Array<double> point_weights(const GridLevel& grid) {
  const EnergyWeight factor(grid);
  if (grid.mesh().region.whole() && !factor.stiffness().any()) return {};
  return of_points(grid, factor,
                   [&](const Run& run, std::size_t i) { return factor.point(run, i); });
}

// A plate of thickness t resists bending as t^3, and changes of bending as t^5.
Array<double> stiffness_roots(const GridLevel& grid) {
  const EnergyWeight factor(grid);
  if (!factor.stiffness().any()) return {};
  return of_points(grid, factor, [&](const Run& run, std::size_t i) {
    return std::pow(factor.stiffness().point(run, i), 5.0 / 6);
  });
}

}  // namespace fairing
