// SPDX-License-Identifier: GPL-3.0-or-later
// The penalty on the distance from a reference surface s beside a curvature energy, on one level:
// sum_i p_i |x_i - s_i|^2. For displacements h along the normals n half the gradient is
// p_i n_i . (x_i - s_i), and p_i is added to the diagonal of K.
#pragma once

#include <vector>

#include "curvature/options.h"
#include "grid/grid_level.h"
#include "parallel/workers.h"
#include "sparse/unknown_points.h"

namespace fairing {

// A level's reference, 3 numbers a point, with the points' penalty
// (grid/limit_surface.h); empty: none.
struct Reference {
  Array<double> points{};
  Array<float> thin{};
};

class DistancePenalty {
 public:
  // `shape`: of a linearized surface (Linearization), whose bending weighs the distances. Weights
  // are zero off the unknowns. `varies`: there are weights beside minimum variation too.
  DistancePenalty(const GridLevel& grid, Reference reference, const Array<float>& shape,
                  const Unknowns& unknowns, bool varies);

  // In what follows beside total curvature, or if it `varies`, minimum variation.
  double energy(const double* x, bool varies, Workers& workers) const;
  // Adds minus half the gradient along the normals to the force, 1 number a point.
  void add_force(const double* x, const double* normal, bool varies, Workers& workers,
                 double* force) const;
  double weight(std::size_t p, bool varies) const {
    return double(varies ? of_variation_[p] : weight_[p]);
  }
  // Minimum variation's K = A S^-1 A + P is about (A + Q) (S + D)^-1 (A + Q). A, S and K have
  // orders 4, 2 and 6, so with the point's area a, diagonals Q = a (P / a)^(2/3) and
  // D = a (P / a)^(1/3) are right for waves that are much longer or shorter than those where A S^-1 A
  // is as large as P, and for these.
  double in_cycles(std::size_t p) const { return double(in_cycles_[p]); }
  double between(std::size_t p) const {
    return in_cycles_[p] > 0 ? in_cycles(p) * in_cycles(p) / weight(p, true) : 0.0;
  }

 private:
  Array<double> points_;
  Array<float> weight_, of_variation_, in_cycles_;
};

}  // namespace fairing
