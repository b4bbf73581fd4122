// SPDX-License-Identifier: GPL-3.0-or-later
// Weights of either fairness energy: a factor at every point near the joint of a region or a soft
// crease and on flat faces, and springs that hold control vertices.
#pragma once

#include <vector>

#include "grid/runs.h"
#include "parallel/memory.h"
#include "stencil/stiffness.h"

namespace fairing {

// Springs that hold control vertices near their targets: w |p - target|^2 is added to the energy.
// One per control vertex, >= 0, in the energy's own unit; empty: none.
using VertexWeights = std::vector<double>;

// The factor on the energy of each point: the surface's stiffness (stiffness.h), times the factor
// at and near a joint, the closed line along which a faired region meets the surface outside. 1
// elsewhere, and on a mesh without either.
//
// RegionContinuity::tangent: 2 on the joint itself. The second difference there contains half of
// the curvature m inside, since the outside has none; the minimizer makes it m / factor; so 2 is
// consistent with a clamped plate.
//
// RegionContinuity::curvature: 1 / t, where t grows from 0 on the joint to 1 across the first ring
// of control faces. The minimizer of the integral of m^2 / t has m of order t: the curvature fades
// out towards the joint. On the joint itself the same consideration for a cubic gives t of a sixth
// of a grid step.
class EnergyWeight {
 public:
  // The mesh of `grid` must outlive it; `grid` itself need not.
  explicit EnergyWeight(const GridLevel& grid)
      : mesh_(grid.mesh()), n_(grid.n()), stiffness_(grid) {}

  // Whether a point there may have a factor other than 1.
  bool weighs_edge(Index e) const { return stiffness_.weighs_edge(e) || joint_weighs_edge(e); }
  bool weighs_face(Index f) const { return stiffness_.weighs_face(f) || joint_weighs_face(f); }

  // The same for a run's points; the factor at its point i.
  bool weighs(const Run& run) const;
  double point(const Run& run, std::size_t i) const { return factor_at(*this, run, i); }

  // The factor of the surface's own stiffness.
  const Stiffness& stiffness() const { return stiffness_; }

  // At a control vertex; at point k of an edge, 0 < k < n; at point (i, j) inside a face.
  double vertex(Index v) const {
    return (any() && clamped_vertex(v) ? on_joint() : 1.0) * stiffness_.vertex(v);
  }
  double edge_point(Index e, int k) const {
    return beside_joint(e, k) * stiffness_.edge_point(e, k);
  }
  double face_point(Index f, int i, int j) const {
    return beside_joint(f, i, j) * stiffness_.face_point(f, i, j);
  }

 private:
  bool joint_weighs_edge(Index e) const;
  bool joint_weighs_face(Index f) const;
  double beside_joint(Index e, int k) const;
  double beside_joint(Index f, int i, int j) const;
  bool any() const { return !mesh_.region.clamped_vertex.empty(); }
  bool clamped_vertex(Index v) const { return mesh_.region.clamped_vertex[v] != 0; }
  bool clamped_edge(Index e) const { return mesh_.region.clamped_edge[e] != 0; }
  const Edge& edge(Index e) const { return mesh_.edges[e]; }
  bool fades() const { return any() && mesh_.region.joint == RegionContinuity::curvature; }
  double on_joint() const { return fades() ? 6.0 * n_ : 2.0; }
  // At `steps` grid steps from the joint, at most n.
  double off_joint(double steps) const { return n_ / steps; }

  const ControlMesh& mesh_;
  int n_;
  Stiffness stiffness_;
};

// One factor a point; empty: all are one. And the root of the stiffness only.
Array<double> point_weights(const GridLevel& grid);
Array<double> stiffness_roots(const GridLevel& grid);

}  // namespace fairing
