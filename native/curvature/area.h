// SPDX-License-Identifier: GPL-3.0-or-later
// Tension beside a curvature energy: tau times the area of the surface, on one level and about one
// surface. The area is that of the grid's triangles; a quad counts as the mean of its two
// triangulations. For displacements h along the normals half the gradient is tau/2 n_i . sum_j c_ij
// (x_i - x_j), where c_ij is half the sum of the cotangents across the edge ij. The cotangent
// Laplacian, tau/2 sum_j c_ij (h_i - h_j), is added to K. It is the same from both ends of an edge,
// so every point's row is gathered from its ring. (The changes of normals and cotangents are
// omitted, so that K is positive.)
#pragma once

#include "multigrid/level_operator.h"
#include "sparse/ring_rows.h"

namespace fairing {

// Area of the surface x without the part outside the region. x: 3 numbers a point.
double surface_area(const GridLevel& grid, Workers& workers, const double* x);

class AreaTerm {
 public:
  explicit AreaTerm(const GridLevel& grid) : weight_(grid, 1) {}

  // Linearizes about the surface x and returns tau times its area. Adds minus half the gradient
  // along the normals to `force` on the unknowns; both may be null. All throw if the run is
  // cancelled.
  double linearize(double tau, const double* x, const double* normal, const Unknowns& unknowns,
                   Workers& workers, double* force);

  // y <- y + L h on the unknowns; 1 number a point.
  template <class T>
  void add_product(const Unknowns& unknowns, Workers& workers, const T* h, T* y) const;
  void add_diagonal(const Unknowns& unknowns, float* diagonal) const;
  // Entries of L by the numbers of the unknowns.
  void add_entries(const std::vector<Index>& number,
                   std::vector<Eigen::Triplet<double>>& entries) const;

  // tau/2 c_ij in slot j of point i; slot 0 is unused.
  const RingRows& weights() const { return weight_; }

 private:
  RingRows weight_;
};

}  // namespace fairing
