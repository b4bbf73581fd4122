// SPDX-License-Identifier: GPL-3.0-or-later
#include "stencil/stiffness.h"

#include <algorithm>

namespace fairing {
namespace {

// Dimensionless. For a ridge in one dimension the width of the hump equals the radius within 6 %
// with 3, 18 % with 10 and 38 % with 100, for weights from 0.2 to 0.9; the overshoot next to it is
// half of the plate's with 0.4.
constexpr double hinge = 3;

// Integral of the bump from 0 to t.
double below(double t) {
  t = std::clamp(t, -1.0, 1.0);
  return t * (15 - t * t * (10 - 3 * t * t)) / 16;
}

}  // namespace

bool Stiffness::soft_edge(Index e) const {
  if (!mesh_.soft.any()) return false;
  const auto& ends = mesh_.edges[e].vertex;
  return mesh_.soft.edge[e] > 0 || at_vertex(ends[0]) > 0 || at_vertex(ends[1]) > 0;
}

bool Stiffness::soft_face(Index f) const {
  if (!mesh_.soft.any()) return false;
  const Face& face = mesh_.faces[f];
  for (int s = 0; s < face.size; ++s)
    if (soft_edge(mesh_.sides[face.first_side + s].edge)) return true;
  return false;
}

// Quadratic B-spline along the line; its control points are the weights of the edges.
double Stiffness::on_edge(Index e, double steps, double whole) const {
  const double middle = mesh_.soft.edge[e];
  if (!(middle > 0) || !(whole > 0)) return 0;
  const auto& ends = mesh_.edges[e].vertex;
  const double t = steps / whole;
  return (1 - t) * (1 - t) * at_vertex(ends[0]) + 2 * t * (1 - t) * middle +
         t * t * at_vertex(ends[1]);
}

// With a radius of less than half a step it is a hinge between two steps.
double Stiffness::compliance(double c, double steps) const {
  const double radius = std::max((1 - c) * n_, 0.5);
  if (!(c > 0) || steps >= n_ || steps - 0.5 >= radius) return 1;
  const double share = below((steps + 0.5) / radius) - below((steps - 0.5) / radius);
  return 1 + hinge * c * n_ * n_ / radius * share;
}

double Stiffness::vertex(Index v) const {
  return (is(mesh_.flat.vertex, v) ? flat_stiffness : 1.0) /
         (soft_vertex(v) ? compliance(at_vertex(v), 0) : 1.0);
}

double Stiffness::edge_point(Index e, int k) const {
  return (is(mesh_.flat.edge, e) ? flat_stiffness : 1.0) /
         (soft_edge(e) ? compliance_on_edge(e, k) : 1.0);
}

double Stiffness::face_point(Index f, int i, int j) const {
  return (is(mesh_.flat.face, f) ? flat_stiffness : 1.0) /
         (soft_face(f) ? compliance_in_face(f, i, j) : 1.0);
}

double Stiffness::compliance_on_edge(Index e, int k) const {
  const auto& ends = mesh_.edges[e].vertex;
  return std::max({compliance(on_edge(e, k, n_), 0), compliance(at_vertex(ends[0]), k),
                   compliance(at_vertex(ends[1]), n_ - k)});
}

double Stiffness::compliance_in_face(Index f, int i, int j) const {
  const Face& face = mesh_.faces[f];
  double most = 1;
  for_distances(face, n_, i, j, [&](std::size_t s, double row, double before, double corner) {
    const Side& side = mesh_.sides[std::size_t(face.first_side) + s];
    const double whole = face.quad() ? n_ : n_ - row;
    const double weight = on_edge(side.edge, side.reversed ? whole - before : before, whole);
    most = std::max({most, compliance(weight, row), compliance(at_vertex(face.vertex[s]), corner)});
  });
  return most;
}

}  // namespace fairing
