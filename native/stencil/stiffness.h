// SPDX-License-Identifier: GPL-3.0-or-later
// How stiff a surface is at and near soft creases, and on faces that are meant flat. Next to such an edge the plate is thin: it bends there,
// rather than elsewhere.
//
// A weight c has the radius r = 1 - c, as a share of the faces beside the edge, and the compliance
// K = hinge c / (1 - c): at a distance d the stiffness is 1 / (1 + K b(d / r) / r), with b the bump
// (15 / 16) (1 - t^2)^2, whose integral is one. So a bending moment that makes a turn of one across the
// faces makes one of K within the radius, and one hump of curvature, about r wide at half its height. A
// grid has its mean over a step, however narrow the crease; at c = 1 it is a hinge.
//
// Faces that are meant flat are stiff, and so are edges and vertices with such faces alone around them.
#pragma once

#include "grid/runs.h"

namespace fairing {

class Stiffness {
 public:
  // The mesh of `grid` must outlive it; `grid` itself need not.
  explicit Stiffness(const GridLevel& grid) : mesh_(grid.mesh()), n_(grid.n()) {}

  // Whether any point there may have a stiffness other than 1.
  bool weighs_vertex(Index v) const { return is(mesh_.flat.vertex, v) || soft_vertex(v); }
  bool weighs_edge(Index e) const { return is(mesh_.flat.edge, e) || soft_edge(e); }
  bool weighs_face(Index f) const { return is(mesh_.flat.face, f) || soft_face(f); }

  bool any() const { return mesh_.soft.any() || !mesh_.flat.face.empty(); }

  // Of point i of a run; of a vertex, and of points on edges and in faces.
  double point(const Run& run, std::size_t i) const;
  double vertex(Index v) const;
  double edge_point(Index e, int k) const;
  double face_point(Index f, int i, int j) const;

 private:
  static bool is(const std::vector<std::uint8_t>& flags, Index element) {
    return !flags.empty() && flags[std::size_t(element)] != 0;
  }
  bool soft_vertex(Index v) const { return mesh_.soft.any() && at_vertex(v) > 0; }
  bool soft_edge(Index e) const;
  bool soft_face(Index f) const;
  double compliance_on_edge(Index e, int k) const;
  double compliance_in_face(Index f, int i, int j) const;
  double at_vertex(Index v) const { return mesh_.soft.vertex[std::size_t(v)]; }
  // The weight on an edge, so many grid steps of the row that is `whole` long from its first vertex.
  double on_edge(Index e, double steps, double whole) const;
  // So many grid steps from a line of weight c.
  double compliance(double c, double steps) const;

  const ControlMesh& mesh_;
  int n_;
};

}  // namespace fairing
