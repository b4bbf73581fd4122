// SPDX-License-Identifier: GPL-3.0-or-later
// Weights on a fairness energy, whatever the energy: a factor on every point beside the joint of a
// region, and springs that hold control vertices.
#pragma once

#include <vector>

#include "grid/runs.h"
#include "parallel/memory.h"

namespace fairing {

// Springs that hold control vertices near their targets: w |p - target|^2 is added to the energy.
// One a control vertex, >= 0, in the energy's own unit; empty: none.
using VertexWeights = std::vector<double>;

// The factor on the energy of each point at and near a joint, the closed line along which a region
// that is faired meets the surface that stays. 1 everywhere else, and on a mesh without a region.
//
// RegionContinuity::tangent: 2 on the joint itself. The second difference there sees half of the
// curvature m inside, for the outside has none; the minimizer makes it m / factor; so 2 is
// consistent with a clamped plate.
//
// RegionContinuity::curvature: 1 / t, where t runs from 0 on the joint to 1 across the first ring
// of control faces. What minimizes the integral of m^2 / t has m of order t: the curvature fades
// out towards the joint. On the joint itself, by the same count with a cubic, t stands for a sixth
// of a grid step.
class RegionWeight {
 public:
  // The mesh of `grid` must outlive it; `grid` itself need not.
  explicit RegionWeight(const GridLevel& grid) : mesh_(grid.mesh()), n_(grid.n()) {}

  // Whether any point there has a factor other than 1.
  bool weighs_edge(Index e) const;
  bool weighs_face(Index f) const;

  // The same of a run's points, and the factor of its point i.
  bool weighs(const Run& run) const;
  double point(const Run& run, std::size_t i) const;

  // Of a control vertex; of point k of an edge, 0 < k < n; of point (i, j) inside a face.
  double vertex(Index v) const { return any() && clamped_vertex(v) ? on_joint() : 1.0; }
  double edge_point(Index e, int k) const;
  double face_point(Index f, int i, int j) const;

 private:
  bool any() const { return !mesh_.region.clamped_vertex.empty(); }
  bool clamped_vertex(Index v) const { return mesh_.region.clamped_vertex[std::size_t(v)] != 0; }
  bool clamped_edge(Index e) const { return mesh_.region.clamped_edge[std::size_t(e)] != 0; }
  const Edge& edge(Index e) const { return mesh_.edges[std::size_t(e)]; }
  bool fades() const { return any() && mesh_.region.joint == RegionContinuity::curvature; }
  double on_joint() const { return fades() ? 6.0 * n_ : 2.0; }
  // So many grid steps from the joint, none further than n.
  double off_joint(double steps) const { return n_ / steps; }

  const ControlMesh& mesh_;
  int n_;
};

// One factor a point; empty: all are one.
Array<double> point_weights(const GridLevel& grid);

}  // namespace fairing
