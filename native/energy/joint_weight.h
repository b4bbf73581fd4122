// SPDX-License-Identifier: GPL-3.0-or-later
// The factor on the energy at and near a joint.
//
// Joint::tangent: 2 on the joint itself. The second difference there sees half of the curvature m inside, for the
// outside has none; the minimizer makes it m / factor; so 2 is consistent with a clamped plate.
//
// Joint::curvature: 1 / t, where t runs from 0 on the joint to 1 across the first ring of control faces. What minimizes
// the integral of m^2 / t has m of order t: the curvature fades out towards the joint. On the joint itself, by the same
// count with a cubic, t stands for a sixth of a lattice step.
#pragma once

#include "lattice/lattice.h"

namespace fairing {

class JointWeight {
 public:
  explicit JointWeight(const Lattice& lattice) : mesh_(lattice.mesh()), n_(lattice.n()) {}

  // Whether any point there has a factor other than 1.
  bool weighs_edge(Index e) const;
  bool weighs_face(Index f) const;

  double vertex(Index v) const { return any() && clamped_vertex(v) ? on_joint() : 1.0; }
  double edge_point(Index e, int k) const;
  double face_point(Index f, int i, int j) const;

 private:
  bool any() const { return !mesh_.region.clamped_vertex.empty(); }
  bool clamped_vertex(Index v) const { return mesh_.region.clamped_vertex[std::size_t(v)] != 0; }
  bool clamped_edge(Index e) const { return mesh_.region.clamped_edge[std::size_t(e)] != 0; }
  const Edge& edge(Index e) const { return mesh_.edges[std::size_t(e)]; }
  bool fades() const { return any() && mesh_.region.joint == Joint::curvature; }
  double on_joint() const { return fades() ? 6.0 * n_ : 2.0; }
  // So many lattice steps from the joint, none further than n.
  double off_joint(double steps) const { return n_ / steps; }

  const ControlMesh& mesh_;
  int n_;
};

}  // namespace fairing
