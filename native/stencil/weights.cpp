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

double EnergyWeight::point(const Run& run, std::size_t i) const {
  const int k = int(i) + 1;
  switch (run.kind) {
    case RunKind::vertex: return vertex(run.element);
    case RunKind::edge: return edge_point(run.element, k);
    default: return face_point(run.element, k, run.row);
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

// The distance to a side in steps is the row; the distance to a corner is the one that agrees with
// the edges on both sides.
double EnergyWeight::beside_joint(Index f, int i, int j) const {
  if (!fades()) return 1;
  const Face& face = mesh_.faces[f];
  const bool quad = face.quad();
  const int far_i = quad ? n_ - i : n_ - i - j, far_j = n_ - j;
  const int row_of_side[4] = {j, far_i, quad ? far_j : i, i};
  double steps = n_;
  for (int s = 0; s < face.size; ++s) {
    const double row = row_of_side[s], before = row_of_side[(s + face.size - 1) % face.size];
    if (clamped_edge(mesh_.sides[face.first_side + s].edge)) steps = std::min(steps, row);
    if (clamped_vertex(face.vertex[s]))
      steps = std::min(steps, quad ? row + before - row * before / n_ : row + before);
  }
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
