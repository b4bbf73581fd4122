// SPDX-License-Identifier: GPL-3.0-or-later
// The stiffness of a surface at and near soft creases, and on flat faces. Next to a soft crease the
// plate is thin, so that it bends there and not elsewhere.
//
// A weight c has the radius r = 1 - c, as a share of the faces next to the edge, and the compliance
// K = hinge c / (1 - c): at a distance d the stiffness is 1 / (1 + K b(d / r) / r), where the bump
// b is (15 / 16) (1 - t^2)^2, with integral one. So a bending moment that makes a turn of one
// across the faces makes a turn of K within the radius, as one hump of curvature whose width at
// half its height is about r. A grid uses the mean over a step, so creases may be narrower; with c
// = 1 it is a hinge.
//
// Flat faces are stiff, and so are edges and vertices with flat faces only. Faces that stay straight
// are stiff in one direction, which their divided differences have (stencil/straight.h).
#pragma once

#include "grid/runs.h"

namespace fairing {

// Stiffness of flat faces, relative to all others. Measured: a beam over supports at distances 70,
// 2, 2 and 70, which turns by 90 degrees over the middle two, deviates from the long ones by 1.07
// with 1, 0.26 with 100 and 0.003 with 10,000; the faces of a phone shell by 2e-2, with 100,000 by
// 1.2e-4 and with a million by 1.2e-5 of its size.
constexpr double flat_stiffness = 1e6;

// The distances of the point (i, j) inside a face from its sides and corners, in grid steps: calls
// visit(s, row, before, corner) with those from side s, from the side before, and from corner s
// between them, which agrees with the edges on both sides.
template <class Visit>
void for_distances(const Face& face, int n, int i, int j, Visit&& visit) {
  const bool quad = face.quad();
  const int row_of_side[4] = {j, quad ? n - i : n - i - j, quad ? n - j : i, i};
  for (int s = 0; s < face.size; ++s) {
    const double row = row_of_side[s], before = row_of_side[(s + face.size - 1) % face.size];
    visit(std::size_t(s), row, before, quad ? row + before - row * before / n : row + before);
  }
}

// `factors` at point i of a run.
template <class Factors>
double factor_at(const Factors& factors, const Run& run, std::size_t i) {
  const int k = int(i) + 1;
  switch (run.kind) {
    case RunKind::vertex: return factors.vertex(run.element);
    case RunKind::edge: return factors.edge_point(run.element, k);
    default: return factors.face_point(run.element, k, run.row);
  }
}

class Stiffness {
 public:
  // The mesh of `grid` must outlive it; `grid` itself need not.
  explicit Stiffness(const GridLevel& grid) : mesh_(grid.mesh()), n_(grid.n()) {}

  // Whether a point there may have a stiffness other than 1.
  bool weighs_vertex(Index v) const { return is(mesh_.flat.vertex, v) || soft_vertex(v); }
  bool weighs_edge(Index e) const { return is(mesh_.flat.edge, e) || soft_edge(e); }
  bool weighs_face(Index f) const { return is(mesh_.flat.face, f) || soft_face(f); }

  bool any() const { return mesh_.soft.any() || !mesh_.flat.face.empty(); }

  // Stiffness at point i of a run; at a vertex, and at points on edges and in faces.
  double point(const Run& run, std::size_t i) const { return factor_at(*this, run, i); }
  double vertex(Index v) const;
  double edge_point(Index e, int k) const;
  double face_point(Index f, int i, int j) const;

 private:
  static bool is(const std::vector<std::uint8_t>& flags, Index element) {
    return !flags.empty() && flags[element] != 0;
  }
  bool soft_vertex(Index v) const { return mesh_.soft.any() && at_vertex(v) > 0; }
  bool soft_edge(Index e) const;
  bool soft_face(Index f) const;
  double compliance_on_edge(Index e, int k) const;
  double compliance_in_face(Index f, int i, int j) const;
  double at_vertex(Index v) const { return mesh_.soft.vertex[v]; }
  // Weight on an edge at `steps` grid steps from its first vertex; its row is `whole` steps long.
  double on_edge(Index e, double steps, double whole) const;
  // Compliance at `steps` grid steps from a line of weight c.
  double compliance(double c, double steps) const;

  const ControlMesh& mesh_;
  int n_;
};

}  // namespace fairing
