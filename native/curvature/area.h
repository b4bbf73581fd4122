// SPDX-License-Identifier: GPL-3.0-or-later
// Tension beside a curvature energy: tau times the area of the surface itself, on one level and
// about one surface. The area is that of the grid's triangles, a quad the mean of its two
// triangulations. For displacements h along the normals half its gradient is tau/2 n_i . sum_j c_ij
// (x_i - x_j), with c_ij half the cotangents across the edge ij, added up; what joins K is the
// cotangent Laplacian, tau/2 sum_j c_ij (h_i - h_j). It is the same from both ends of an edge, so
// every point's row is gathered from its ring. (The normals' change from point to point, and the
// cotangents', are left out: K is positive.)
#pragma once

#include "curvature/ring_jacobian.h"
#include "multigrid/level_operator.h"

namespace fairing {

// The area of what is not outside a region: x has 3 numbers a point.
double surface_area(const GridLevel& grid, Workers& workers, const double* x);

class AreaTerm {
 public:
  explicit AreaTerm(const GridLevel& grid) : weight_(grid, 1) {}

  // About the surface x, of which it returns tau times the area. Adds to `force` on the unknowns
  // minus half its gradient along the normals; both may be null. All throw where the run has been
  // cancelled.
  double linearize(double tau, const double* x, const double* normal, const Unknowns& unknowns,
                   Workers& workers, double* force);

  // y <- y + L h on the unknowns; one number a point.
  template <class T>
  void add_product(const Unknowns& unknowns, Workers& workers, const T* h, T* y) const;
  void add_diagonal(const Unknowns& unknowns, float* diagonal) const;
  // Entries of L by the unknowns' numbers.
  void add_entries(const std::vector<Index>& number,
                   std::vector<Eigen::Triplet<double>>& entries) const;

  // tau/2 c_ij in slot j of point i; slot 0 is not used.
  const RingJacobian& weights() const { return weight_; }

 private:
  RingJacobian weight_;
};

}  // namespace fairing
